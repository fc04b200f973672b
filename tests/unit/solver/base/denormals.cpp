#include "solver/base/denormals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>

#include "solver/base/error.hpp"
#include "solver/run/make_initial_state.hpp"
#include "solver/run/run.hpp"
#include "tests/support/own_process.hpp"

namespace myowave::solver {
namespace {

// By the bits: with denormals-are-zero, std::fpclassify treats denormals as zero too.
bool is_denormal(double value) {
  constexpr std::uint64_t exponent = 0x7ff0000000000000, mantissa = 0x000fffffffffffff;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return (bits & exponent) == 0 && (bits & mantissa) != 0;
}

TEST(Denormals, AreDistinguishedFromZeroByTheirBits) {
  EXPECT_TRUE(is_denormal(std::numeric_limits<double>::denorm_min()));
  EXPECT_TRUE(is_denormal(-std::numeric_limits<double>::denorm_min()));
  EXPECT_FALSE(is_denormal(std::numeric_limits<double>::min()));
  EXPECT_FALSE(is_denormal(0));
}

// Number of threads on which half of the smallest normal number is not zero.
int threads_with_denormals() {
  using Host = Kokkos::DefaultHostExecutionSpace;
  const int threads = Host().concurrency();
  int count = 0;
  Kokkos::parallel_reduce(
      "threads_with_denormals",
      Kokkos::RangePolicy<Host, Kokkos::Schedule<Kokkos::Static>>(0, threads).set_chunk_size(1),
      [](int, int& sum) {
        const volatile double smallest = std::numeric_limits<double>::min();
        const volatile double half = smallest * 0.5;
        sum += std::bit_cast<std::uint64_t>(static_cast<double>(half)) != 0 ? 1 : 0;
      },
      count);
  return count;
}

TEST(Denormals, AreFlushedOnEveryThreadWhileTheGuardExists) {
  if (const std::string path = test::report_path(); !path.empty()) {
    std::ofstream report(path);
    report << threads_with_denormals();
    {
      const FlushDenormals flush;
      report << ' ' << threads_with_denormals();
      { const FlushDenormals again; }
      report << ' ' << threads_with_denormals();
    }
    report << ' ' << threads_with_denormals();
    return;
  }
  EXPECT_EQ(test::report_of_own_process("OMP_NUM_THREADS=1"), "1 0 0 1");
  if (Kokkos::DefaultHostExecutionSpace::name() == std::string("OpenMP")) {
    EXPECT_EQ(test::report_of_own_process("OMP_NUM_THREADS=3"), "3 0 0 3");
  }
}

// Notes the mode during the run; throws at its end if it is to.
struct ModeSink final : OutputSink {
  bool fails = false;
  int flushed = 0;
  void progress(const Progress& p) override {
    if (threads_with_denormals() == 0) ++flushed;
    if (fails && p.t == p.t_end) throw Interrupted("as asked for");
  }
};

TEST(Denormals, ARunLeavesTheModeOfEveryThreadAsItWas) {
  if (const std::string path = test::report_path(); !path.empty()) {
    Scene scene;
    scene.grid = {21, 21, 0.6};
    scene.time.t_end = 1;
    scene.initial.preconditions = {{.duration = 1, .contraction = false, .excitation = {}, .tension = {}}};
    scene.mechanics.emplace();
    std::ofstream report(path);
    for (const bool fails : {false, true}) {
      ModeSink sink;
      sink.fails = fails;
      RunSummary summary;
      const auto mode = denormal_mode();
      const bool threw = [&] {
        try {
          run(scene, make_initial_state(scene), sink, summary);
          return false;
        } catch (const Interrupted&) {
          return true;
        }
      }();
      const bool same = denormal_mode() == mode;
      report << (threw == fails) << (sink.flushed > 0) << same << threads_with_denormals() << ' ';
    }
    return;
  }
  EXPECT_EQ(test::report_of_own_process("OMP_NUM_THREADS=1"), "1111 1111 ");
  if (Kokkos::DefaultHostExecutionSpace::name() == std::string("OpenMP")) {
    EXPECT_EQ(test::report_of_own_process("OMP_NUM_THREADS=3"), "1113 1113 ");
  }
}

// V decays as exp(-k a t) = exp(-0.8 t) at rest: from 1e-304 it becomes denormal at t = 12 and is still above
// the smallest denormal at t = 20.
TEST(Denormals, DoNotStayInASheetAtRest) {
  Scene scene;
  scene.grid = {121, 121, 0.6};
  scene.time.t_end = 20;
  InitialState state = make_initial_state(scene);
  for (int i = 0; i < 121; ++i)
    for (int j = 0; j < 121; ++j) state.V[i * 121 + j] = 1e-304 * (1.5 + std::sin(0.1 * i + 0.2 * j));
  ASSERT_TRUE(is_denormal(1e-304 * std::exp(-0.8 * 20)));

  OutputSink sink;
  RunSummary summary;
  const InitialState end = run(scene, state, sink, summary);
  EXPECT_EQ(std::count_if(end.V.begin(), end.V.end(), is_denormal), 0);
  EXPECT_EQ(std::count_if(end.r.begin(), end.r.end(), is_denormal), 0);
  EXPECT_EQ(std::count_if(end.Ta.begin(), end.Ta.end(), is_denormal), 0);
  // V has decayed until its change dt k a V is flushed, if the processor rounds that product before it adds
  // it.
  const double change = scene.time.dt * scene.excitation.k * scene.excitation.a;
  EXPECT_LT(*std::max_element(end.V.begin(), end.V.end()), std::numeric_limits<double>::min() / change);
}

}  // namespace
}  // namespace myowave::solver
