#include "base/units.hpp"

#include <cmath>
#include <numbers>

#include "base/near.hpp"

namespace whirl {
namespace {

struct Row {
  const char* text;
  Dimension dimension;
  double value_SI;
};

TEST(Units, AreTurnedIntoSI) {
  const Row kRows[] = {
      {"50 ms", Dimension::time, 0.05},
      {"3.2 N", Dimension::force, 3.2},
      {"4.2 m/s", Dimension::speed, 4.2},
      {"10 %", Dimension::ratio, 0.1},
      {" 10 in ", Dimension::length, 0.254},
      {"60 rpm", Dimension::angular_rate, 2 * std::numbers::pi},
      {"2200 mAh", Dimension::charge, 7920.0},
      {"25 degC", Dimension::temperature, 298.15},
      {"-3", Dimension::none, -3.0},
      {"0.0125 kg m2", Dimension::inertia, 0.0125},
      {"+12 %", Dimension::ratio, 0.12},
      {"-50 ppm", Dimension::ratio, -5e-5},
  };
  for (const Row& row : kRows) {
    const auto got = parse_quantity(row.text, "test");
    ASSERT_TRUE(got.ok()) << row.text;
    EXPECT_EQ(got.value().dimension, row.dimension) << row.text;
    EXPECT_TRUE(near(got.value().value_SI, row.value_SI, round_off(4, row.value_SI))) << row.text;
  }
}

TEST(Units, RefuseWhatIsNotAQuantity) {
  for (const char* text :
       {"", "ms", "five ms", "+-5 ms", "+", "5 furlong", "5 m s", "nan s", "inf m", "1e999 m"}) {
    EXPECT_FALSE(parse_quantity(text, "test").ok()) << text;
  }
}

TEST(Units, NameThePlaceTheWrongDimensionAndTheCure) {
  const auto wrong = parse_quantity_as("3 N", Dimension::time, "hover.lua:12");
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(wrong.error().message(),
            "hover.lua:12: '3 N' is a force, not a time (a time is written with ns us ms s min)");
}

TEST(Units, TheWayBackShowsWhatWasWritten) {
  for (const char* text : {"50 ms", "3.2 N", "25 degC", "10 %", "4500 rpm", "0.0125 kg m2"}) {
    const auto quantity = parse_quantity(text, "test").value();
    const std::string symbol = unit_symbol(text);
    EXPECT_TRUE(near(in_unit(quantity.value_SI, symbol), std::stod(text),
                     round_off(8, std::stod(text) + 300.0)))
        << text;
  }
  EXPECT_EQ(unit_symbol("-3"), "");
  EXPECT_TRUE(std::isnan(in_unit(1.0, "furlong")));
  EXPECT_STREQ(si_suffix(Dimension::speed), "mps");
}

TEST(Units, EverySISymbolMeansOne) {
  for (int d = 0; d <= static_cast<int>(Dimension::magnetic_field); ++d) {
    const auto dimension = static_cast<Dimension>(d);
    const std::string symbol = si_symbol(dimension);
    if (symbol.empty()) continue;
    const auto one = parse_quantity_as("1 " + symbol, dimension, "test");
    ASSERT_TRUE(one.ok()) << symbol;
    EXPECT_EQ(one.value(), 1.0) << symbol;
  }
}

TEST(Units, DurationsAreWholeNanoseconds) {
  EXPECT_EQ(parse_duration_ns("0.1 us", "").value(), 100);
  EXPECT_FALSE(parse_duration_ns("1e12 s", "").ok());
}

}  // namespace
}  // namespace whirl
