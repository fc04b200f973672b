// Time to write a checkpoint until it is on the disk, in the folder for temporary files:
//   checkpoint / n      251: contracting, V, r, Ta, 25 x 25 elements; 4096: rigid, V, r
#include "solver/run/checkpoint.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "bench/sheet.hpp"
#include "bench/suite.hpp"
#include "solver/coupling/electromechanics.hpp"

namespace myowave::bench {
namespace {

solver::InitialState waves(int n) {
  solver::InitialState state{n, n, {}, {}, {}};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      state.V.push_back(initial_V(i, j));
      state.r.push_back(initial_r(i, j));
      state.Ta.push_back(initial_Ta(i, j));
    }
  return state;
}

void time_checkpoint(benchmark::State& state, int n, bool contracts) {
  solver::Scene scene;
  scene.grid = {n, n, dx};
  if (contracts) scene.mechanics.emplace();
  scene.output.tension = contracts;
  solver::PhaseSeconds phases;
  solver::MechanicsStatistics statistics;
  solver::Electromechanics<ExecutionSpace, double> sheet(solver::Execution{}, scene, waves(n), phases,
                                                         statistics);
  if (contracts) sheet.solve_mechanics(0);
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("myowave_bench_{}", getpid());
  solver::CheckpointKeeper keeper(folder, "a benchmark");
  measure(state, 1, [&] {
    solver::StateWriter writer;
    sheet.save(writer);
    keeper.keep(writer, 0, 0, "");
  });
  std::vector<std::string> refused;
  const auto found = solver::find_checkpoint(folder, refused);
  if (!found) return fail(state, "no checkpoint was written");
  state.counters["bytes_per_s"] =
      benchmark::Counter(static_cast<double>(found->bytes.size()) * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
  solver::StateReader reader(found->state());
  sheet.load(reader, 0);
  if (!reader.at_end()) fail(state, "the checkpoint has more bytes than were read");
  keeper.remove_all();
}

}  // namespace

void register_checkpoint(const Suite& suite) {
  for (const int n : suite.sizes({251, 4096}, 251))
    add_row(fmt::format("checkpoint/{}", n),
            [=](benchmark::State& state) { time_checkpoint(state, n, n == 251); });
}

}  // namespace myowave::bench
