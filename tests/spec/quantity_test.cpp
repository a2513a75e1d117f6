// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers with units.
#include "spec/quantity.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "leapmap/errors.hpp"
#include "leapmap/units.hpp"
#include "model/fields.hpp"
#include "model/parameters.hpp"

namespace leapmap {
namespace {

constexpr Scales hoop{.radius = 0.06, .gravity = 9.81, .mass = 0.158};
constexpr double rounding = 1e-15;  // of a product of three factors, relative

double number(const std::string& text, std::string_view own, const Scales& scales = hoop) {
  return number_in_own_unit(text, own, scales);
}

std::string refusal(const std::string& text, std::string_view own, const Scales& scales = hoop) {
  try {
    return "accepted as " + std::to_string(number(text, own, scales));
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Quantities, OfTheHoopsOwnUnitsAreThoseOfItsSize) {
  const double time = std::sqrt(0.06 / 9.81);
  const auto is = [](double value, double expected) { EXPECT_NEAR(value / expected, 1.0, 4.0 * rounding); };
  is(number("60 mm", "m"), 0.06);
  is(number("60mm", "hoop diameters"), 0.5);
  is(number("0.06 m", "R"), 1.0);
  is(number("1.2 m", "revolutions"), 1.2 / (2.0 * std::numbers::pi * 0.06));
  is(number("300 rpm", "sqrt(g/R)"), 10.0 * std::numbers::pi * time);
  is(number("-90 deg/s", "sqrt(g/R)"), -0.5 * std::numbers::pi * time);
  is(number("1.5 m/s", "sqrt(g R)"), 1.5 / std::sqrt(9.81 * 0.06));
  is(number("0.04 N m", "(m + m_p) g R"), 0.04 / (0.158 * 9.81 * 0.06));
  is(number("40 mNm", "(m + m_p) g R"), 0.04 / (0.158 * 9.81 * 0.06));
  is(number("40 mJ", "(m + m_p) g R"), 0.04 / (0.158 * 9.81 * 0.06));
  is(number("20 N ms", "(m + m_p) sqrt(g R)"), 0.02 / (0.158 * std::sqrt(9.81 * 0.06)));
  is(number("1.9e-4 kg m2", "kg m2"), 1.9e-4);
  is(number("190000 g mm2", "kg m2"), 1.9e-4);
  is(number("20 ms", "sqrt(R/g)"), 0.02 / time);
  is(number("1.62 m/s2", "m s-2"), 1.62);
}

TEST(Quantities, WithoutAUnitAreInTheirOwn) {
  EXPECT_EQ(number(" 0.5 ", "hoop diameters"), 0.5);
  EXPECT_EQ(number("-1.2e3", "rad"), -1200.0);
  EXPECT_EQ(number("+.5", "1"), 0.5);
  EXPECT_EQ(number("5 rad", "rad"), 5.0);
}

TEST(Quantities, InDegreesAreTheSameBitsAsEver) {
  for (const double angle : {0.1, 23.0, 180.0, -33.58})
    EXPECT_EQ(number(fmt::format("{}deg", angle), "rad"), angle * degrees(1.0));
  EXPECT_NEAR(number("30 °", "rad"), degrees(30.0), 1e-15);
}

TEST(Quantities, OfAnotherKindOrOfNoneAreRefused) {
  EXPECT_EQ(refusal("60 mmm", "m"), "'60 mmm': the unit 'mmm' is unknown");
  for (const auto& [text, own] : {std::pair{"60 s", "m"},
                                  {"3 g", "m"},
                                  {"3 m", "kg"},
                                  {"10 s", "sqrt(g/R)"},    // a reciprocal
                                  {"50 Hz", "sqrt(g/R)"},   // radians or turns
                                  {"50 s-1", "sqrt(g/R)"},  // likewise
                                  {"20 %", "rad"},
                                  {"2 m2", "m"},
                                  {"5 K", "m"},
                                  {"5 m @ 3", "m"},
                                  {"1 1/m", "m"}})
    EXPECT_NE(refusal(text, own).find("'"), std::string::npos) << refusal(text, own);
  EXPECT_EQ(refusal("60 s", "m"), "'60 s' cannot be converted to m");
  EXPECT_EQ(refusal("50 Hz", "sqrt(g/R)"), "'50 Hz' cannot be converted to rad s-1");
  EXPECT_EQ(refusal("3 m", "1"), "'3 m' has a unit, and this number has none");
  for (const char* text : {"1 200 mm", "1.5.2 mm", "6 mm 10", "3 1e3mm", "2 m/2", "2 3", "2 1/m", "5 mm -3"})
    EXPECT_NE(refusal(text, "m").find("is unknown"), std::string::npos) << text;
  EXPECT_NE(refusal(std::string("5 mm\0m", 7), "m").find("is unknown"), std::string::npos);
  EXPECT_NEAR(number("3 m s^-1", "sqrt(g R)") * std::sqrt(9.81 * 0.06), 3.0, 1e-14);
  EXPECT_NEAR(number("3 m.s-1", "sqrt(g R)") * std::sqrt(9.81 * 0.06), 3.0, 1e-14);
  for (const char* text : {"", "mm", "e5", "nan", "inf", "--3", "0x10", "1,5 mm"})
    EXPECT_EQ(refusal(text, "m").find("accepted"), std::string::npos) << text;
  EXPECT_EQ(refusal("0.04 N m", "(m + m_p) g R", {.radius = 0.06, .gravity = 9.81}),
            "'0.04 N m' needs the total mass too, by [hoop], scene.mass or --mass");
}

TEST(Quantities, GoBackToWhatTheyWere) {
  for (const OwnUnit& own : own_units) {
    const auto factor = units_in_own(own.example, own.name, hoop);
    ASSERT_TRUE(factor) << own.name;
    EXPECT_NEAR(number("3 " + std::string(own.example), own.name) * *factor, 3.0, 3.0 * 8.0 * rounding)
        << own.name;
  }
  EXPECT_FALSE(units_in_own("mm", "s", hoop));
  EXPECT_FALSE(units_in_own("N m", "(m + m_p) g R", {.radius = 0.06, .gravity = 9.81}));
  EXPECT_THROW(static_cast<void>(units_in_own("mmm", "m", hoop)), InputError);
}

TEST(Quantities, EveryParameterAndFieldHasAUnitThatIsKnown) {
  for (const Parameter& parameter : parameters())
    EXPECT_TRUE(parameter.unit == "1" || find_own_unit(parameter.unit)) << parameter.name;
  std::size_t own = 0;
  for (const Field& field : map_fields()) {
    EXPECT_TRUE(own_unit(field) == "1" || find_own_unit(own_unit(field))) << field.name << own_unit(field);
    own += own_unit(field) != field.unit;
  }
  EXPECT_GT(own, 10u);  // hoop diameters, R, sqrt(g/R) and so on
  EXPECT_EQ(own_unit(*find_field("jump_height")), "hoop diameters");
  EXPECT_EQ(own_unit(*find_field("landing_impulse")), "(m + m_p) sqrt(g R)");
  EXPECT_EQ(own_unit(*find_field("landing_normal_speed")), "sqrt(g R)");
  EXPECT_EQ(own_unit(*find_field("landing_energy_lost")), "(m + m_p) g R");
  EXPECT_EQ(own_unit(*find_field("slip_distance")), "R");
  EXPECT_EQ(own_unit(*find_field("gait_speed")), "m s-1");
}

}  // namespace
}  // namespace leapmap
