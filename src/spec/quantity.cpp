// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/quantity.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <array>
#include <cctype>
#include <cmath>
#include <memory>
#include <mutex>
#include <string>

#include "leapmap/errors.hpp"
#include "leapmap/units.hpp"
#include "support/number.hpp"
#include "support/printable.hpp"

namespace leapmap {
namespace {

using Unit = std::unique_ptr<ut_unit, decltype(&ut_free)>;
using Converter = std::unique_ptr<cv_converter, decltype(&cv_free)>;

/// Whether a text is of units alone. UDUNITS also takes numbers among them, so that "1 200 mm" would be one
/// of "200 mm", and offsets, as Celsius thermometers have. A digit may be an exponent: m2, s-1, m^2.
bool is_plain(std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto begins_exponent = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '^'; };
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '@' || static_cast<unsigned char>(text[i]) < ' ') return false;
    if (!is_digit(text[i])) continue;
    std::size_t before = i;
    while (before > 0 && is_digit(text[before - 1])) --before;
    if (before > 1 && (text[before - 1] == '-' || text[before - 1] == '+')) --before;
    if (before == 0 || !begins_exponent(text[before - 1])) return false;
  }
  return true;
}

/// The units that UDUNITS knows, "deg", which it calls degree, and "Nm".
class UnitSystem {
 public:
  UnitSystem() : system_(nullptr, &ut_free_system) {
    ut_set_error_message_handler(ut_ignore);
    system_.reset(ut_read_xml(nullptr));
    const Unit degree = parsed("degree");
    const Unit torque = parsed("N.m");
    if (!degree || ut_map_name_to_unit("deg", UT_ASCII, degree.get()) != UT_SUCCESS || !torque ||
        ut_map_symbol_to_unit("Nm", UT_ASCII, torque.get()) != UT_SUCCESS)
      throw InputError("UDUNITS cannot read its list of units; allowed: with the package libudunits2-data");
  }

  /// Null: unknown.
  Unit parsed(std::string_view text) const {
    const std::string whole(text);
    return {system_ && is_plain(text) ? ut_parse(system_.get(), whole.c_str(), UT_UTF8) : nullptr, &ut_free};
  }

 private:
  std::unique_ptr<ut_system, decltype(&ut_free_system)> system_;
};

/// What a unit measures, by its definition without the factor: "m2.kg.s-2". UDUNITS itself counts angles as
/// pure numbers, and converts reciprocals.
std::string kind_of(const ut_unit* unit) {
  std::array<char, 256> definition{};
  const int length = ut_format(unit, definition.data(), definition.size(), UT_ASCII | UT_DEFINITION);
  if (length <= 0 || static_cast<std::size_t>(length) >= definition.size()) return "?";
  const std::string text(definition.data());
  return text.substr(text.find(' ') == text.npos ? 0 : text.find(' ') + 1);
}

/// How many of the SI's unit one `unit` is; nothing: they are of different kinds.
std::optional<double> in_si(std::string_view unit, const char* si) {
  static std::mutex turn;  // UDUNITS keeps its state unguarded
  const std::scoped_lock lock(turn);
  static const UnitSystem system;
  const Unit from = system.parsed(unit), to = system.parsed(si);
  if (!from) throw InputError(fmt::format("the unit '{}' is unknown", unit));
  if (kind_of(from.get()) != kind_of(to.get())) return {};
  const Converter converter(ut_get_converter(from.get(), to.get()), &cv_free);
  if (!converter) return {};
  const double size = cv_convert_double(converter.get(), 1.0);
  return std::isfinite(size) && size > 0.0 ? std::optional(size) : std::nullopt;
}

}  // namespace

std::size_t length_of_number(std::string_view text) {
  std::size_t at = 0;
  const auto skip = [&](std::string_view any, std::size_t most) {
    const std::size_t from = at;
    while (at < text.size() && at - from < most && any.find(text[at]) != any.npos) ++at;
    return at - from;
  };
  constexpr std::string_view digits = "0123456789";
  skip("+-", 1);
  std::size_t found = skip(digits, text.size());
  if (skip(".", 1) > 0) found += skip(digits, text.size());
  if (found == 0) return 0;
  const std::size_t mantissa = at;
  if (skip("eE", 1) > 0) {
    skip("+-", 1);
    if (skip(digits, text.size()) > 0) return at;
  }
  return mantissa;
}

namespace {

struct Parts {
  double number;
  std::string_view unit;  // empty: none
};

Parts parts_of(std::string_view text) {
  const std::string_view whole = trimmed(text);
  const std::size_t length = length_of_number(whole);
  const std::optional<double> number = number_in(whole.substr(0, length));
  if (!number) throw InputError(fmt::format("'{}' is not a number", text));
  return {*number, trimmed(whole.substr(length))};
}

/// A unit, found in `text`, in the SI unit of one of leapmap's own.
double size_in_si(std::string_view text, std::string_view unit, const OwnUnit& own) {
  std::optional<double> size;
  try {
    size = in_si(unit, own.si);
  } catch (const InputError& error) {
    throw InputError(fmt::format("'{}': {}", text, error.what()));
  }
  if (!size) throw InputError(fmt::format("'{}' cannot be converted to {}", text, own.si));
  return *size;
}

}  // namespace

std::optional<double> units_in_own(std::string_view unit, std::string_view own, const Scales& scales) {
  const OwnUnit* known = find_own_unit(own);
  if (!known) return {};
  const std::optional<double> size = in_si(unit, known->si);
  const double ours = known->size(scales);
  return size && ours > 0.0 ? std::optional(ours / *size) : std::nullopt;
}

double number_in_own_unit(std::string_view text, std::string_view own, const Scales& scales) {
  const Parts parts = parts_of(text);
  if (parts.unit.empty() || parts.unit == own) return parts.number;
  if (own == "rad" && parts.unit == "deg") return parts.number * degrees(1.0);  // as ever, to the last bit
  const OwnUnit* known = find_own_unit(own);
  if (!known) throw InputError(fmt::format("'{}' has a unit, and this number has none", text));
  const double size = size_in_si(text, parts.unit, *known);
  const double ours = known->size(scales);
  if (std::isnan(ours))
    throw InputError(fmt::format("'{}' needs the diameter, and each hoop has its own", text));
  if (!(ours > 0.0))
    throw InputError(fmt::format("'{}' needs the total mass too, by [hoop], scene.mass or --mass", text));
  return parts.number * size / ours;
}

std::optional<double> number_in_si(std::string_view text, const OwnUnit& own) {
  const Parts parts = parts_of(text);
  if (parts.unit.empty() || parts.unit == own.name) return {};
  return parts.number * size_in_si(text, parts.unit, own);
}

}  // namespace leapmap
