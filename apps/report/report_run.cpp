#include "apps/report/report_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>

#include "apps/input/schema.hpp"
#include "apps/results/observable_table.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// "out/spiral" and "out/spiral/" are "spiral".
std::string name_of(const fs::path& folder) {
  const fs::path whole = fs::absolute(folder).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

json read_manifest(const fs::path& folder) {
  const fs::path path = folder / "manifest.json";
  std::ifstream file(path);
  if (!file) return nullptr;
  try {
    return json::parse(file);
  } catch (const json::exception& error) {
    throw solver::InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

RunResults read_results(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw solver::InputError(fmt::format("{}: there is no such folder", folder.string()));
  }
  if (!fs::exists(folder / "manifest.json") && !fs::exists(folder / "summary.json")) {
    throw solver::InputError(fmt::format(
        "{}: there is no manifest.json, summary.json or reproduction.json: not the folder of a run",
        folder.string()));
  }
  return RunResults(folder, RunResults::Unfinished::accept);
}

// Four significant digits, which is more than any of these numbers is sure of.
std::string digits(double value) { return fmt::format("{:.4g}", value); }

std::string spread(const json& value, double factor) {
  std::string text = digits(factor * value["mean"].get<double>());
  if (value.contains("sd") && value["sd"].is_number())
    text += " ± " + digits(factor * value["sd"].get<double>());
  return text;
}

std::string in_words(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

constexpr std::string_view time_unit = "t.u.";

// Of an observable by the name of its fact: "core: radius"; empty: a number without unit.
std::string_view unit_of(const std::string& name) {
  std::string path;
  for (const char letter : name)
    if (letter != ' ') path += letter == ':' ? '/' : letter;
  const ObservableRow* row = find_observable_row(path);
  return row == nullptr ? "" : row->unit.text;
}

std::string value_text(std::string_view unit, const json& value, double ms_per_tu) {
  if (value.is_number() && unit == time_unit) {
    const double t = value.get<double>();
    return fmt::format("{:.6g} t.u. ({:.6g} ms)", t, t * ms_per_tu);
  }
  if (value.is_number_float())
    return fmt::format("{}{}{}", digits(value.get<double>()), unit.empty() ? "" : " ", unit);
  return value.is_string() ? value.get<std::string>() : value.dump();
}

void add_mean(std::vector<Fact>& facts, const std::string& name, const json& value, double ms_per_tu) {
  std::string text = spread(value, 1);
  if (unit_of(name + ": mean") == time_unit) text += fmt::format(" t.u. ({} ms)", spread(value, ms_per_tu));
  if (value.contains("n") && value["n"].is_number()) text += fmt::format(", n = {}", value["n"].dump());
  facts.push_back({in_words(name), text});
}

// {"start": 1, "pair": 14} as "start 1, pair 14".
std::optional<std::string> counts(const json& value) {
  std::string text;
  for (const auto& [name, number] : value.items()) {
    if (!number.is_number_integer()) return std::nullopt;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", in_words(name), number.dump());
  }
  return text;
}

void add_observable(std::vector<Fact>& facts, const std::string& name, const json& value, double ms_per_tu) {
  if (value.is_null()) return;
  if (!value.is_object()) {
    const std::string bare = name.ends_with("_tu") ? name.substr(0, name.size() - 3) : name;
    facts.push_back({in_words(bare), value_text(unit_of(name), value, ms_per_tu)});
    return;
  }
  if (const auto text = counts(value)) {
    facts.push_back({in_words(name), *text});
    return;
  }
  if (value.contains("mean") && value["mean"].is_number()) add_mean(facts, name, value, ms_per_tu);
  for (const auto& [member, one] : value.items()) {
    const bool of_mean = member == "mean" || member == "sd" || member == "n";
    if (of_mean && value.contains("mean")) continue;
    add_observable(facts, fmt::format("{}: {}", name, member), one, ms_per_tu);
  }
}

const Key* key_of(const std::string& section, const std::string& name) {
  const Section* found = find_section(section);
  return found == nullptr ? nullptr : find_key(*found, name);
}

}  // namespace

ReportRun::ReportRun(const fs::path& folder)
    : name_(name_of(folder)), results_(read_results(folder)), manifest_(read_manifest(folder)) {
  if (results_.summary().is_null()) notes_.emplace_back("The run is not finished: there is no summary.json.");
  if (manifest_.is_null()) notes_.emplace_back("There is no manifest.json: the parameters are not known.");
  probes_ = table("probes.csv", {"t", "V0"}, true);
  tips_ = table("tips.csv", {"t", "x", "y", "charge"}, true);
  area_ = table("area.csv", {"t", "area", "area_min", "area_max"}, true);
  sources_ = table("sources.csv", {"t", "sources"}, false);
  beats_ = table("beats.csv", {"probe", "upstroke_tu", "period_tu", "apd90_tu", "di_tu"}, false);
}

CsvTable ReportRun::table(const char* file, const std::vector<std::string>& columns, bool expected) {
  const fs::path path = results_.folder() / file;
  if (!fs::exists(path)) {
    if (expected) notes_.push_back(fmt::format("There is no {}.", file));
    return {};
  }
  CsvTable result = read_csv(path);
  for (const std::string& column : columns) {
    if (result.has(column)) continue;
    notes_.push_back(fmt::format("{} is left out: it has no column {}.", file, column));
    return {};
  }
  if (result.left_out > 0) {
    notes_.push_back(fmt::format("{}: {} {} cut off and left out.", file, result.left_out,
                                 result.left_out == 1 ? "row is" : "rows are"));
  }
  return result;
}

json ReportRun::configuration() const {
  return manifest_.is_object() && manifest_.contains("configuration") ? manifest_["configuration"] : json();
}

double ReportRun::ms_per_tu() const {
  return configuration().is_null() ? solver::TimeSettings{}.ms_per_tu
                                   : configuration().value("/time/ms_per_tu"_json_pointer, 10.0);
}

std::vector<Fact> ReportRun::numbers() const {
  std::vector<Fact> facts;
  const json summary = results_.summary();
  if (!summary.is_object()) return facts;
  const double ms = ms_per_tu();
  if (summary.contains("t")) facts.push_back({"reached", value_text(time_unit, summary["t"], ms)});
  if (summary.contains("observables"))
    for (const auto& [name, value] : results_.summary()["observables"].items())
      add_observable(facts, name, value, ms);
  return facts;
}

std::vector<ChangedParameter> ReportRun::changed_parameters() const {
  solver::Scene plain;
  const json given = configuration();
  if (!given.is_object()) return {};
  // The defaults of a contracting sheet hold where it contracts.
  const bool deforms = given.value("/mechanics/on"_json_pointer, false);
  if (deforms) plain.mechanics.emplace();
  const json defaults = effective_configuration(plain);
  std::vector<ChangedParameter> changed;
  for (const auto& [section, keys] : given.items()) {
    if (!keys.is_object()) {
      changed.push_back({section, keys, nullptr, "", ""});
      continue;
    }
    for (const auto& [name, value] : keys.items()) {
      const json by_default =
          defaults.contains(section) && defaults[section].contains(name) ? defaults[section][name] : json();
      const bool turned_on = section == "mechanics" && name == "on";
      if (value == by_default && !turned_on) continue;
      const Key* key = key_of(section, name);
      changed.push_back({section + "." + name, value, turned_on ? json(false) : by_default,
                         key ? std::string(key->unit) : "", key ? std::string(key->doc) : ""});
    }
  }
  return changed;
}

}  // namespace myowave::apps
