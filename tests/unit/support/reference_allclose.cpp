#include <gmock/gmock.h>

#include <limits>
#include <vector>

#include "tests/support/allclose.hpp"

namespace myowave::testing_support {
namespace {

using ::testing::HasSubstr;

TEST(AllClose, AcceptsWhatIsWithinEitherTolerance) {
  const std::vector<double> expected{0, 100, -2}, actual{1e-7, 100.5, -2};
  EXPECT_TRUE(all_close(actual, expected, 3, {.absolute = 1e-6, .relative = 0.01}));
  EXPECT_FALSE(all_close(actual, expected, 3, {.absolute = 1e-6}));
  EXPECT_FALSE(all_close(actual, expected, 3, {.relative = 0.01}));
  EXPECT_TRUE(all_close(expected, expected, 3, {}));
}

TEST(AllClose, NamesTheWorstEntriesFirst) {
  const std::vector<double> expected(6, 1.0), actual{1, 1, 1.5, 1, 3, 1};
  const auto result = all_close(actual, expected, 3, {.absolute = 0.1});
  ASSERT_FALSE(result);
  const std::string message = result.message();
  EXPECT_THAT(message, HasSubstr("2 of 6 entries"));
  EXPECT_THAT(message, HasSubstr("(1, 1): 3, expected 1"));
  EXPECT_LT(message.find("(1, 1)"), message.find("(0, 2)"));
}

TEST(AllClose, ListsNoMoreThanAskedFor) {
  const std::vector<double> expected(4, 0.0), actual{1, 2, 3, 4};
  const std::string message = all_close(actual, expected, 4, {}, 1).message();
  EXPECT_THAT(message, HasSubstr("(0, 3)"));
  EXPECT_THAT(message, ::testing::Not(HasSubstr("(0, 2)")));
}

TEST(AllClose, RejectsNanInfinityAndOtherSizes) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(all_close(std::vector{nan}, std::vector{0.0}, 1, {.absolute = 1e9}));
  EXPECT_FALSE(all_close(std::vector{nan}, std::vector{nan}, 1, {.absolute = 1e9}));
  EXPECT_FALSE(all_close(std::vector{0.0}, std::vector{inf}, 1, {.absolute = 1, .relative = 1}));
  EXPECT_TRUE(all_close(std::vector{inf}, std::vector{inf}, 1, {}));
  EXPECT_FALSE(all_close(std::vector{1.0, 2.0}, std::vector{1.0}, 1, {.absolute = 1e9}));
}

}  // namespace
}  // namespace myowave::testing_support
