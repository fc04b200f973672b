// Which of its stages a run is in.
#pragma once

#include <cstddef>
#include <string>

namespace myowave::solver {

struct RunStage {
  enum class Kind {
    settling,      // makes the settled spiral that the run starts from
    precondition,  // not observed
    scene,
  };
  Kind kind = Kind::scene;
  std::size_t number = 0;         // from 0, preconditions first
  std::size_t preconditions = 0;  // how many the run has

  bool operator==(const RunStage&) const = default;
};

// "settling the spiral", "precondition 1 of 2", "run".
std::string stage_text(const RunStage&);

}  // namespace myowave::solver
