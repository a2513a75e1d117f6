// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/fields.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "model/own_units.hpp"
#include "model/parameters.hpp"
#include "model/variable.hpp"
#include "trajectory/later_jump.hpp"

namespace leapmap {
namespace {

constexpr std::array<std::string_view, status_count> status_names = [] {
  std::array<std::string_view, status_count> names;
  for (int i = 0; i < status_count; ++i) names[static_cast<std::size_t>(i)] = name_of(static_cast<Status>(i));
  return names;
}();
constexpr std::array<std::string_view, 2> spurious_names{"first_lift_off_is_the_jump",
                                                         "first_lift_off_is_spurious"};

/// A row with what a solver has to be asked for.
Field needing(bool Wanted::*what, Field field) {
  field.needs = what;
  return field;
}

/// A measure of the jump's landing: told wherever one looks, but stored only if it is named.
Field of_landing(std::string_view name, double Outcome::*member, std::string_view meaning) {
  Field field{name, Quantity{member}, "1", meaning, 12};
  field.by_default = ByDefault::told;
  return needing(&Wanted::landing, field);
}

/// Of a wall to clear, which the flight determines.
Field of_wall(std::string_view name, double Outcome::*member, std::string_view meaning) {
  Field field{name, Quantity{member}, "1", meaning, 12};
  field.of_wall = true;
  return needing(&Wanted::landing, field);
}

/// Measures of the way to a jump. The design is solved once more for them, so that they cost as much as the
/// jump.
Field of_way(std::string_view name, double Outcome::*member, std::string_view meaning) {
  Field field{name, Quantity{member}, "1", meaning, 13};
  field.by_default = ByDefault::left_out, field.of_way = true;
  return field;
}

/// The same of a pendulum's motor only.
Field of_robot(std::string_view name, double Outcome::*member, std::string_view meaning) {
  Field field = of_way(name, member, meaning);
  field.since = 18, field.only_of = Mechanism::pendulum;
  return field;
}

const std::array fields{
    Field{"jump_height", Quantity{&Outcome::jump_height, Measure::height}, "1",
          "apex of the jump above the plane, in hoop diameters"},
    needing(&Wanted::jump_time, Field{"jump_time", Quantity{&Outcome::jump_time, Measure::time}, "s",
                                      "time from release to the lift-off of the jump"}),
    Field{"spurious_first_jump",
          Code{[](const Outcome& o) { return o.spurious_first_jump; },
               [](Outcome& o, std::uint8_t code) { o.spurious_first_jump = code; }, Outcome::no_lift_off,
               spurious_names},
          "1", "whether the first lift-off stays below hop_height"},
    Field{"status",
          Code{[](const Outcome& o) { return static_cast<std::uint8_t>(o.status); },
               [](Outcome& o, std::uint8_t code) {
                 o.status = code < status_count ? static_cast<Status>(code) : Status::not_computed;
               },
               0, status_names},
          "1", "how the design ended"},
    Field{"jump_angle", Quantity{&Outcome::jump_angle}, "rad", "angle phi at the lift-off of the jump"},
    Field{"jump_spin", Quantity{&Outcome::jump_spin}, "1", "spin at the lift-off of the jump, in sqrt(g/R)"},
    Field{"jump_distance", Quantity{&Outcome::jump_distance}, "1",
          "distance travelled by the hoop's centre from release to the lift-off of the jump, in R"},
    Field{"apex_time", Quantity{&Outcome::apex_time, Measure::time}, "s",
          "time from the lift-off of the jump to its apex"},
    needing(&Wanted::descent, Field{"flight_time", Quantity{&Outcome::flight_time, Measure::time}, "s",
                                    "time from the lift-off of the jump to its landing"}),
    Field{"first_jump_height", Quantity{&Outcome::first_jump_height, Measure::height}, "1",
          "apex of the first lift-off above the plane, in hoop diameters"},
    needing(&Wanted::first_jump_time,
            Field{"first_jump_time", Quantity{&Outcome::first_jump_time, Measure::time}, "s",
                  "time from release to the first lift-off"}),
    needing(&Wanted::descent,
            Field{"dip", Quantity{&Outcome::dip, Measure::height}, "1",
                  "lowest height of the hoop right after the lift-off of the jump, in hoop diameters; "
                  "negative: its penetration depth"}),
    Field{"candidates",
          Code{[](const Outcome& o) { return o.candidates; },
               [](Outcome& o, std::uint8_t code) { o.candidates = code; },
               255,
               {}},
          "1", "number of lift-offs up to the jump, the jump included; 254: at least 254"},
    Field{
        "phase_sequence", Word{&Outcome::phase_sequence}, "1",
        "contact phases, two bits each, the first lowest, up to 32: 1 rolling, 2 sliding, 3 flight; 0: none",
        3, Friction::coulomb},
    Field{
        "slip_distance", Quantity{&Outcome::slip_distance}, "1",
        "distance slid from release to the lift-off of the jump, or without a jump to the end of the motion, "
        "in R; NaN if the hoop rocks to rest",
        3, Friction::coulomb},
    needing(&Wanted::descent,
            Field{"landing_spin", Quantity{&Outcome::landing_spin}, "1",
                  "spin after the landing of the jump, in sqrt(g/R)", 3, Friction::coulomb}),
    Field{"energy_lost", Quantity{&Outcome::energy_lost}, "1",
          "energy lost from release to the lift-off of the jump, in (m + m_p) g R", 3, Friction::coulomb},
    of_landing("jump_range", &Outcome::jump_range,
               "travel of the hoop's centre from the lift-off of the jump to its landing, in R"),
    of_landing("landing_normal_speed", &Outcome::landing_normal_speed,
               "speed of the contact point towards the plane just before the landing, in sqrt(g R)"),
    of_landing("landing_tangential_speed", &Outcome::landing_tangential_speed,
               "velocity of the contact point along the plane just before the landing, positive downhill, in "
               "sqrt(g R)"),
    of_landing("landing_impulse", &Outcome::landing_impulse,
               "normal impulse of the whole landing, in (m + m_p) sqrt(g R); below zero without slip: the "
               "plane would have to pull"),
    of_landing("landing_energy_lost", &Outcome::landing_energy_lost,
               "kinetic energy lost in the landing, in (m + m_p) g R"),
    of_wall("clears_from", &Outcome::clears_from,
            "first place along the plane, from the lift-off of the jump, at which the hoop flies over a thin "
            "wall of scene.clear_height, in R; of several stretches, that of the highest place"),
    of_wall("clears_to", &Outcome::clears_to, "last place of that stretch, in R"),
    of_way("max_normal_force", &Outcome::max_normal_force,
           "largest normal force from release to the lift-off of the jump, in (m + m_p) g"),
    of_way("motor_energy", &Outcome::motor_energy,
           "work of the motor from release to the lift-off of the jump, in (m + m_p) g R"),
    of_way("motor_max_power", &Outcome::motor_max_power,
           "largest power of the motor from release to the lift-off of the jump, in (m + m_p) g sqrt(g R); "
           "below zero: it only brakes"),
    of_way("motor_max_spin", &Outcome::motor_max_spin,
           "largest spin from release to the lift-off of the jump, either way, in sqrt(g/R); of a pendulum "
           "its spin relative to the hoop"),
    of_robot("motor_max_torque", &Outcome::motor_max_torque,
             "largest torque of the motor from release to the lift-off of the jump, either way, in (m + m_p) "
             "g R"),
    of_robot("efficiency", &Outcome::efficiency,
             "weight times height of the jump over the work of the motor up to its lift-off"),
    Field{"jumps",
          Code{[](const Outcome& o) { return static_cast<std::uint8_t>(o.jumps()); },
               [](Outcome& o, std::uint8_t code) { o.later_jumps.resize(code > 1 ? code - 1u : 0u); },
               255,
               {}},
          "1", "number of jumps, at most scene.jumps", 9, OnlyOf{}, true},
    Field{"sequence_end",
          Code{[](const Outcome& o) { return static_cast<std::uint8_t>(o.sequence_end); },
               [](Outcome& o, std::uint8_t code) {
                 o.sequence_end = code < status_count ? static_cast<Status>(code) : Status::not_computed;
               },
               0, status_names},
          "1", "how the sequence of jumps ended; jumped: all scene.jumps were made", 9, OnlyOf{}, true},
    Field{"sequence_condition", Quantity{&Outcome::sequence_condition}, "1",
          "growth factor, up to the last landing, of errors at the release and at every landing", 10,
          OnlyOf{}, true, false, ByDefault::left_out},
    Field{"gait_period",
          Code{[](const Outcome& o) { return o.gait_period; },
               [](Outcome& o, std::uint8_t code) { o.gait_period = code; },
               255,
               {}},
          "1", "period of the gait in jumps; 0: the jumps end; 255: no period found", 9, OnlyOf{}, false,
          true},
    Field{"gait_multiplier", Quantity{&Outcome::gait_multiplier}, "1",
          "Floquet multiplier: growth of a small deviation over one period of the gait", 9, OnlyOf{}, false,
          true},
    Field{"gait_height", Quantity{&Outcome::gait_height, Measure::height}, "1",
          "mean height of the gait's jumps, in hoop diameters", 9, OnlyOf{}, false, true},
    Field{"gait_speed", Quantity{&Outcome::gait_speed}, "m s-1", "mean speed of the gait down the plane", 9,
          OnlyOf{}, false, true},
    Field{"gait_jump_time", Quantity{&Outcome::gait_jump_time, Measure::time}, "s",
          "mean time from one jump of the gait to the next", 14, OnlyOf{}, false, true},
    Field{"gait_energy_lost", Quantity{&Outcome::gait_energy_lost}, "1",
          "energy lost per jump of the gait, in (m + m_p) g R", 9, OnlyOf{}, false, true},
};

}  // namespace

std::span<const Field> map_fields() { return fields; }

std::string_view own_unit(const Field& field) {
  if (field.unit != "1") return field.unit;
  std::string_view found = field.unit;
  for (const OwnUnit& own : own_units) {
    const std::string words = ", in " + std::string(own.name);
    const std::size_t at = field.long_name.find(words), end = at + words.size();
    const bool said =
        at != std::string_view::npos && (end == field.long_name.size() || field.long_name[end] == ';');
    if (said && (found == "1" || own.name.size() > found.size())) found = own.name;
  }
  return found;
}

bool has(const Scene& scene, const Field& field) {
  if (const auto* later = std::get_if<OfJump>(&field.source);
      later && later->number.jump > static_cast<std::size_t>(scene.jumps))
    return false;
  return has(scene, field.only_of) && (!field.of_sequence || scene.jumps > 1) &&
         (!field.of_gait || scene.settle > 0) && (!field.of_wall || scene.clear_height > 0.0);
}

namespace {

/// What rows that are made of others refer to.
struct RowTexts {
  std::string name, unit, long_name;
};

/// Whether maps may hold a quantity of later jumps, too.
bool is_told_of_later(const Field& field) {
  return field.name == "jump_height" || field.name == "jump_time" || field.by_default == ByDefault::told ||
         field.of_wall || field.of_way;
}

struct JumpTable {
  std::deque<RowTexts> texts;
  std::vector<Field> rows;

  JumpTable() {
    for (std::size_t jump = 2; jump <= static_cast<std::size_t>(most_jumps); ++jump) {
      const std::string number = std::to_string(jump), which = "jump " + number;
      for (const Field& field : fields) {
        const auto* of = std::get_if<Quantity>(&field.source);
        double Jump::*const member = of && is_told_of_later(field) ? later_member(of->member) : nullptr;
        if (!member) continue;
        std::string meaning(field.long_name);
        const auto put = [&](std::string_view words, const std::string& others) {
          if (const std::size_t at = meaning.find(words); at != meaning.npos)
            meaning.replace(at, words.size(), others);
        };
        if (field.of_way) put("from release to", "from the landing before to");
        put("the jump", which), put("the landing;", "its landing;");
        const RowTexts& text =
            texts.emplace_back(RowTexts{std::string(field.name) + "_" + number, {}, meaning});
        Field row = field;
        row.name = text.name, row.long_name = text.long_name, row.of_sequence = true;
        row.source = OfJump{{member, jump}, of->measure};
        row.since = field.since < 9 ? 9 : 14;
        rows.push_back(row);
      }
    }
  }
};

/// Which of the rows has that name; nullptr: none.
const Field* find_among(std::span<const Field> rows, std::string_view name) {
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const Field& field) { return field.name == name; });
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace

std::span<const Field> jump_fields() {
  static const JumpTable table;
  return table.rows;
}

std::vector<const Field*> fields_of(const Scene& scene) {
  std::vector<const Field*> all;
  for (const Field& field : fields)
    if (has(scene, field)) all.push_back(&field);
  if (scene.jumps == 1) return all;  // the table of later jumps takes a megabyte
  for (const Field& field : jump_fields())
    if (has(scene, field)) all.push_back(&field);
  return all;
}

std::optional<OutcomeNumber> number_of(const Field& field) {
  if (const auto* quantity = std::get_if<Quantity>(&field.source)) return quantity->member;
  if (const auto* later = std::get_if<OfJump>(&field.source)) return later->number;
  return std::nullopt;
}

namespace {

/// Whether only the model has it that has no derivatives.
bool is_of_pendulum(const OnlyOf& only_of) { return only_of.model == Mechanism::pendulum; }

}  // namespace

bool can_be_differentiated(const Field& field) {
  const bool has_derivatives = !field.of_sequence || !(field.of_wall || field.of_way);
  return number_of(field) && !field.of_gait && has_derivatives && !is_of_pendulum(field.only_of) &&
         (field.by_default != ByDefault::left_out || field.of_way);
}

bool can_be_differentiated(const Field& field, const Scene& scene) {
  return can_be_differentiated(field) && !(field.of_wall && scene.clear_height_in_metres);
}

namespace {

std::string unit_of_derivative(std::string_view of, std::string_view by) {
  if (of == by) return "1";
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> inverses{
      {{"rad", "rad-1"}, {"kg", "kg-1"}, {"m", "m-1"}, {"kg m2", "kg-1 m-2"}}};
  for (const auto& [unit, inverse] : inverses)
    if (by == unit) return std::string(of == "1" ? "" : of) + (of == "1" ? "" : " ") + std::string(inverse);
  return std::string(of);  // by a pure number, or one that is told in words
}

struct GradientTable {
  std::deque<RowTexts> texts;
  std::vector<Field> rows;

  void add(const Field& field) {
    if (!can_be_differentiated(field)) return;
    const OutcomeNumber of = *number_of(field);
    for (const Parameter& parameter : parameters()) {
      const auto* by = std::get_if<double Design::*>(&parameter.member);
      if (!by || is_of_pendulum(parameter.only_of)) continue;
      const bool own = parameter.unit != "rad" && parameter.unit != "1";
      const std::string name(field.name), parameter_name(parameter.name);
      const RowTexts& text = texts.emplace_back(
          RowTexts{name + "_by_" + parameter_name, unit_of_derivative(field.unit, parameter.unit),
                   "derivative of " + name + " by " + parameter_name +
                       (own ? ", which is in " + std::string(parameter.unit) : std::string())});
      rows.push_back(Field{text.name, Derivative{of, *by}, text.unit, text.long_name,
                           std::max(7, field.since), both(parameter.only_of, field.only_of),
                           field.of_sequence});
      rows.back().needs = field.needs, rows.back().of_wall = field.of_wall;
    }
  }

  explicit GradientTable(std::span<const Field> of) {
    for (const Field& field : of) add(field);
  }
};

}  // namespace

std::span<const Field> gradient_fields() {
  static const GradientTable table(fields);
  return table.rows;
}

namespace {

std::span<const Field> later_gradient_fields() {
  static const GradientTable table(jump_fields());
  return table.rows;
}

}  // namespace

const Field* find_body_gradient(const OutcomeNumber& of, std::string_view key) {
  struct Row {
    std::string key;
    RowTexts texts;
    Field field;
  };
  static std::mutex mutex;
  static std::map<std::string, Row, std::less<>> rows;
  const auto all = of.jump == 1 ? map_fields() : jump_fields();
  const auto field = std::find_if(all.begin(), all.end(), [&](const Field& each) {
    return can_be_differentiated(each) && number_of(each) == of;
  });
  const BodyNumber* number = find_body_number(key);
  if (field == all.end() || !number) return nullptr;
  std::string name = std::string(field->name) + "_by_" + std::string(key);
  const std::lock_guard lock(mutex);
  const auto [at, is_new] = rows.try_emplace(name);
  Row& row = at->second;
  if (!is_new) return &row.field;
  row.key = key;
  row.texts = {name, unit_of_derivative(field->unit, number->unit),
               "derivative of " + std::string(field->name) + " by " + row.key};
  row.field = Field{row.texts.name,
                    Derivative{of, nullptr, row.key},
                    row.texts.unit,
                    row.texts.long_name,
                    14,
                    field->only_of,
                    field->of_sequence};
  row.field.needs = field->needs, row.field.of_wall = field->of_wall;
  return &row.field;
}

const Field* find_gradient(const OutcomeNumber& of, double Design::*by) {
  for (const Field& field : of.jump == 1 ? gradient_fields() : later_gradient_fields()) {
    const auto& derivative = std::get<Derivative>(field.source);
    if (derivative.of == of && derivative.by == by) return &field;
  }
  return nullptr;
}

namespace {

struct ScatterTable {
  std::deque<RowTexts> texts;
  std::vector<Field> rows;

  void add(Statistic statistic, const Field* of, std::string_view name, std::string_view meaning,
           bool has_error) {
    const std::string full = (of ? std::string(of->name) + "_" : std::string()) + std::string(name);
    const std::string told =
        std::string(meaning) +
        (of ? " over the manufactured hoops that jump: " + std::string(of->long_name) : "");
    const auto put = [&](const std::string& as, const std::string& long_name, bool error) {
      const RowTexts& text = texts.emplace_back(RowTexts{as, std::string(of ? of->unit : "1"), long_name});
      rows.push_back(Field{text.name,
                           OfMade{statistic, of ? std::get<Quantity>(of->source).member : nullptr, error},
                           text.unit, text.long_name, of ? std::max(8, of->since) : 8,
                           of ? of->only_of : OnlyOf{}, of && of->of_sequence, of && of->of_gait});
    };
    put(full, told, false);
    if (has_error) put(full + "_error", "standard error of " + full, true);
  }

  ScatterTable() {
    add(Statistic::yield, nullptr, "yield", "fraction of manufactured hoops that reach every goal", true);
    add(Statistic::cut_off, nullptr, "cut_off",
        "fraction of the tolerances' distribution outside the parameters' domains", false);
    add(Statistic::unsolved, nullptr, "unsolved",
        "fraction of manufactured hoops that the method could not solve", false);
    for (const Field& field : fields) {
      if (!std::holds_alternative<Quantity>(field.source)) continue;
      add(Statistic::mean, &field, "mean", "mean", true);
      add(Statistic::sd, &field, "sd", "standard deviation", true);
      add(Statistic::q05, &field, "q05", "5 % quantile", true);
      add(Statistic::q50, &field, "q50", "median", true);
      add(Statistic::q95, &field, "q95", "95 % quantile", true);
    }
    rows.push_back(
        {"worst_case", OfMade{Statistic::worst_case, &Outcome::jump_height, false}, "1",
         "least jump height of manufactured hoops and of the corners of uniform tolerances, in hoop "
         "diameters; 0: one does not jump",
         17, OnlyOf(Mechanism::hoop, Friction::sticking)});
  }
};

}  // namespace

std::span<const Field> scatter_fields() {
  static const ScatterTable table;
  return table.rows;
}

std::span<const Field> proof_fields() {
  static constexpr std::string_view findings[]{"not_computed", "proved", "crossed", "open"};
  static const auto row = [](ProofColumn column, std::string_view name, std::string_view unit,
                             std::string_view long_name) {
    Field field{name, column, unit, long_name, 17};
    if (column == ProofColumn::finding) field.source = Code{nullptr, nullptr, 0, findings};
    field.only_of = {Mechanism::hoop, Friction::sticking}, field.by_default = ByDefault::left_out,
    field.of_proof = column;
    return field;
  };
  static const std::array<Field, proof_columns> rows{
      row(ProofColumn::finding, "proof", "1",
          "what is proved of all designs of the cell: one outcome; a discontinuity crosses it; neither"),
      row(ProofColumn::height_low, "jump_height_low", "1",
          "no design of a proved cell jumps lower, in hoop diameters"),
      row(ProofColumn::height_high, "jump_height_high", "1",
          "no design of a proved cell jumps higher, in hoop diameters"),
      row(ProofColumn::time_low, "jump_time_low", "s", "no jump of a proved design begins sooner"),
      row(ProofColumn::time_high, "jump_time_high", "s", "no jump of a proved design begins later")};
  return rows;
}

std::vector<const Field*> quantities_of(const std::vector<const Field*>& statistics) {
  std::vector<const Field*> quantities;
  for (const Field& field : map_fields())
    if (const auto* quantity = std::get_if<Quantity>(&field.source))
      if (std::any_of(statistics.begin(), statistics.end(),
                      [&](const Field* row) { return std::get<OfMade>(row->source).of == quantity->member; }))
        quantities.push_back(&field);
  return quantities;
}

const Field* find_field(std::string_view name) {
  if (const Field* found = find_among(fields, name)) return found;
  if (!name.empty() && name.back() >= '0' && name.back() <= '9')
    if (const Field* found = find_among(jump_fields(), name)) return found;
  if (const std::size_t at = name.find("_by_hoop."); at != name.npos) {
    const Field* of = find_field(name.substr(0, at));
    const auto number = of ? number_of(*of) : std::nullopt;
    return number ? find_body_gradient(*number, name.substr(at + std::string_view("_by_").size())) : nullptr;
  }
  if (name.find("_by_") != name.npos) {
    if (const Field* found = find_among(gradient_fields(), name)) return found;
    if (const Field* found = find_among(later_gradient_fields(), name)) return found;
  }
  if (const Field* found = find_among(scatter_fields(), name)) return found;
  return find_among(proof_fields(), name);
}

double stored_number(const Field& field, const Outcome& outcome) {
  if (const auto number = number_of(field)) return number->of(outcome);
  const auto* code = std::get_if<Code>(&field.source);
  return code && code->value && code->value(outcome) != code->fill ? code->value(outcome) : Outcome::none;
}

}  // namespace leapmap
