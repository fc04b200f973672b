// A run is bitwise identical with any number of threads.
#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <fstream>
#include <initializer_list>
#include <string>
#include <utility>

#include "apps/base/content_hash.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"
#include "tests/support/own_process.hpp"
#include "tests/support/recording_sink.hpp"

namespace myowave {
namespace {

// Of the bits.
std::string hash(std::initializer_list<const std::vector<double>*> fields) {
  std::string bytes;
  for (const auto* field : fields)
    bytes.append(reinterpret_cast<const char*>(field->data()), field->size() * sizeof(double));
  return apps::content_hash(bytes);
}

solver::Scene coupled_spiral(solver::Precision precision, solver::MetricForm metric) {
  solver::Scene scene;
  scene.grid = {81, 81, 0.6};
  scene.time.t_end = 5;  // 250 steps
  scene.precision = precision;
  scene.metric = metric;
  scene.mechanics.emplace();
  scene.mechanics->interval = 25;
  scene.initial.type = solver::InitialSettings::Type::broken_front;
  scene.output.every = 5;
  scene.output.tips_every = 0.2;
  return scene;
}

void write_report(const std::string& path) {
  std::ofstream report(path);
  report << Kokkos::DefaultExecutionSpace().concurrency() << '\n';
  for (const auto precision : {solver::Precision::float64, solver::Precision::float32})
    for (const auto metric : {solver::MetricForm::conservative, solver::MetricForm::expanded}) {
      const solver::Scene scene = coupled_spiral(precision, metric);
      test::RecordingSink sink;
      sink.keep_fields = true;
      solver::RunSummary summary;
      const auto state = solver::run(scene, solver::make_initial_state(scene), sink, summary);
      report << hash({&state.V, &state.r, &state.Ta, &sink.nodes}) << ' '
             << summary.mechanics.newton_iterations << '\n';
      for (const auto& sample : sink.tip_samples)
        for (const auto& tip : sample.tips)
          report << std::hexfloat << sample.t << ' ' << tip.x << ' ' << tip.y << ' ' << tip.charge << '\n';
    }
}

TEST(Threads, DoNotChangeTheBitsOfACoupledRun) {
  if (const std::string path = test::report_path(); !path.empty()) return write_report(path);
  const auto report_with = [](const std::string& threads) {
    const std::string report = test::report_of_own_process("OMP_NUM_THREADS=" + threads);
    const auto first_line_end = report.find('\n');
    EXPECT_EQ(report.substr(0, first_line_end), threads);
    return report.substr(first_line_end + 1);
  };
  if (Kokkos::DefaultExecutionSpace::name() != std::string("OpenMP"))
    GTEST_SKIP() << "the number of threads is not OpenMP's";
  const std::string one = report_with("1");
  EXPECT_GT(one.size(), 1000U);
  EXPECT_EQ(report_with("2"), one);
  EXPECT_EQ(report_with("3"), one);
}

}  // namespace
}  // namespace myowave
