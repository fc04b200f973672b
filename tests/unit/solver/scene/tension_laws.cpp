// The laws of the active tension: a law set by name brings its rates, and a rate of its own goes before the
// law's.
#include "solver/scene/tension_laws.hpp"

#include <gmock/gmock.h>

#include "solver/base/error.hpp"
#include "solver/excitation/select_model.hpp"

namespace myowave::solver {
namespace {

TEST(TensionLaws, ALawSetByNameBringsItsRates) {
  TensionSettings tension;
  EXPECT_EQ(tension_parameters(tension).eps_below, 1);
  EXPECT_EQ(tension_parameters(tension).eps_above, 0.1);
  tension.law = tension_law("printed");
  EXPECT_EQ(tension_parameters(tension).eps_below, 1);
  EXPECT_EQ(tension_parameters(tension).eps_above, 10);
  tension.law = tension_law("none");
  EXPECT_EQ(tension_parameters(tension).eps_below, 0);
  EXPECT_EQ(tension_parameters(tension).eps_above, 0);
}

TEST(TensionLaws, ARateOfItsOwnGoesBeforeTheLaws) {
  const TensionSettings tension{.law = TensionLaw::printed, .k_Ta = 30, .eps_above = 3, .threshold = 0.1};
  EXPECT_EQ(tension_parameters(tension).k_Ta, 30);
  EXPECT_EQ(tension_parameters(tension).eps_below, 1);
  EXPECT_EQ(tension_parameters(tension).eps_above, 3);
  EXPECT_EQ(tension_parameters(tension).threshold, 0.1);
}

TEST(TensionLaws, TheModelRelaxesAtTheRatesOfTheLaw) {
  const auto model = make_model<double>({}, {.law = TensionLaw::printed});
  EXPECT_EQ(model.tension.rate(0.5, 0), 10 * 47.9 * 0.5);
  EXPECT_EQ(model.tension.rate(0.01, 0), 1 * 47.9 * 0.01);
}

TEST(TensionLaws, NamesAreThoseOfTheEnumerators) {
  EXPECT_EQ(tension_law("delayed"), TensionLaw::delayed);
  EXPECT_EQ(tension_law("printed"), TensionLaw::printed);
  EXPECT_EQ(tension_law("none"), TensionLaw::none);
  for (const NamedTensionLaw& row : tension_laws) EXPECT_EQ(row_of(tension_law(row.name)).name, row.name);
  EXPECT_THAT([] { tension_law("late"); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("\"delayed\" \"printed\" \"none\"")));
}

}  // namespace
}  // namespace myowave::solver
