#include "apps/input/did_you_mean.hpp"

#include <gtest/gtest.h>

namespace {

using myowave::apps::did_you_mean;

const std::vector<std::string_view> names{"interval", "tolerance", "mu1", "mu2", "dt", "t_end", "edges"};

TEST(did_you_mean, finds_a_slip) {
  EXPECT_EQ(did_you_mean("intervall", names), "interval");
  EXPECT_EQ(did_you_mean("intrval", names), "interval");
  EXPECT_EQ(did_you_mean("inetrval", names), "interval");  // a swap is one edit
  EXPECT_EQ(did_you_mean("Interval", names), "interval");
  EXPECT_EQ(did_you_mean("tend", names), "t_end");
  EXPECT_EQ(did_you_mean("edge", names), "edges");
}

TEST(did_you_mean, takes_the_nearest_and_among_equals_the_first) {
  EXPECT_EQ(did_you_mean("mu2", names), "mu2");
  EXPECT_EQ(did_you_mean("mu3", names), "mu1");
}

TEST(did_you_mean, leaves_another_word_alone) {
  EXPECT_EQ(did_you_mean("banana", names), "");
  EXPECT_EQ(did_you_mean("xy", names), "");
  EXPECT_EQ(did_you_mean("", names), "");
  EXPECT_EQ(did_you_mean(std::string(100000, 'a'), names), "");
  EXPECT_EQ(did_you_mean("interval", {}), "");
}

}  // namespace
