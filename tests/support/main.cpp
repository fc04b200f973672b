// main of every test: Kokkos around GoogleTest. --file=SOURCE, a path from the root, runs the tests of that
// source only.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <cstdio>
#include <string>
#include <string_view>

namespace {

// The filter that selects the tests that are defined in the file; empty if there are none.
std::string filter_of_file(std::string_view path) {
  const std::string end = fmt::format("/{}", path);
  std::string filter;
  const auto& tests = *testing::UnitTest::GetInstance();
  for (int n = 0; n < tests.total_test_suite_count(); ++n) {
    const auto& suite = *tests.GetTestSuite(n);
    for (int m = 0; m < suite.total_test_count(); ++m) {
      const auto& test = *suite.GetTestInfo(m);
      if (fmt::format("/{}", test.file()).ends_with(end))
        filter += fmt::format("{}{}.{}", filter.empty() ? "" : ":", suite.name(), test.name());
    }
  }
  return filter;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  constexpr std::string_view option = "--file=";
  for (int n = 1; n < argc; ++n) {
    if (!std::string_view(argv[n]).starts_with(option)) continue;
    const std::string filter = filter_of_file(argv[n] + option.size());
    if (filter.empty()) {
      std::fprintf(stderr, "no test is defined in %s\n", argv[n] + option.size());
      return 1;
    }
    GTEST_FLAG_SET(filter, filter);
  }
  const Kokkos::ScopeGuard kokkos(argc, argv);
  return RUN_ALL_TESTS();
}
