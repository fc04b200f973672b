#include "solver/base/run_stage.hpp"

#include <fmt/format.h>

namespace myowave::solver {

std::string stage_text(const RunStage& stage) {
  switch (stage.kind) {
    case RunStage::Kind::settling:
      return "settling the spiral";
    case RunStage::Kind::precondition:
      return fmt::format("precondition {} of {}", stage.number + 1, stage.preconditions);
    case RunStage::Kind::scene:
      break;
  }
  return "run";
}

}  // namespace myowave::solver
