#include "apps/sweep/axis_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>
#include <set>

#include "apps/input/did_you_mean.hpp"
#include "apps/input/schema.hpp"

namespace myowave::apps {
namespace {

// Of computed values: 0.0975 + 0.0025 is then 0.1, and no two systems differ in the last bits of a power.
double rounded(double value) { return std::strtod(fmt::format("{:.12g}", value).c_str(), nullptr); }

nlohmann::ordered_json json_of(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* integer = node.as_integer()) return integer->get();
  if (const auto* number = node.as_floating_point()) return number->get();
  if (const auto* flag = node.as_boolean()) return flag->get();
  return toml_value(node);
}

Place place_of(const toml::node& node) {
  const toml::source_position begin = node.source().begin;
  return {begin.line, begin.column};
}

// What an axis varies: a key of the schema, or a whole section of it.
struct Varied {
  const Section* section = nullptr;
  const Key* key = nullptr;
};

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// "stimulus.0.amplitude" -> "stimulus", "amplitude".
std::vector<std::string> names_in(std::string_view path) {
  std::vector<std::string> names;
  for (;;) {
    const auto dot = path.find('.');
    if (!is_number(path.substr(0, dot))) names.emplace_back(path.substr(0, dot));
    if (dot == std::string_view::npos) return names;
    path.remove_prefix(dot + 1);
  }
}

std::string unknown_key_hint(const Section* section, const std::string& name) {
  if (section != nullptr) {
    std::vector<std::string_view> names;
    for (const Key& key : section->keys) names.push_back(key.name);
    for (const std::string_view other : section->inherits)
      for (const Key& key : find_section(other)->keys) names.push_back(key.name);
    const std::string meant = did_you_mean(name, names);
    return meant.empty() ? fmt::format("; keys of [{}]: {}", section->name, fmt::join(names, ", "))
                         : hint(fmt::format("{}.{}", section->name, meant));
  }
  std::vector<std::string_view> sections;
  for (const Section& one : schema()) {
    if (one.inherits.empty() && find_key(one, name) != nullptr)
      return hint(fmt::format("{}.{}", one.name, name));
    sections.push_back(one.name);
  }
  return fmt::format("; sections: {}", fmt::join(sections, ", "));
}

Varied find_varied(const toml::node& node, const std::string& path, Problems& problems) {
  const auto names = names_in(path);
  const std::string whole = fmt::format("{}", fmt::join(names, "."));
  if (const Section* section = find_section(whole)) return {section, nullptr};
  const auto dot = whole.rfind('.');
  const std::string last = names.empty() ? path : names.back();
  const std::string before = dot == std::string::npos ? "" : whole.substr(0, dot);
  const Section* section = find_section(before);
  if (const Key* key = section == nullptr ? nullptr : find_key(*section, last)) return {section, key};
  std::string help = unknown_key_hint(section, last);
  if (section == nullptr && !before.empty()) {
    std::vector<std::string_view> sections;
    for (const Section& one : schema()) sections.push_back(one.name);
    if (const auto meant = did_you_mean(before, sections); !meant.empty())
      help = hint(fmt::format("{}.{}", meant, last));
  }
  problems.add(node.source(),
               fmt::format("a scene has no key \"{}\" to be the key of an axis{}", printable(path), help));
  return {};
}

// Paths of a value are relative to the sweep file, those of an override to the working directory.
void place_paths(const Varied& varied, toml::node& value, const std::filesystem::path& folder) {
  const auto place = [&](const Key* key, toml::node& node) {
    auto* const path = node.as_string();
    if (key != nullptr && std::holds_alternative<Path>(key->kind) && path != nullptr)
      *path = (folder / path->get()).string();
  };
  if (varied.key != nullptr) return place(varied.key, value);
  if (auto* const table = value.as_table())
    for (auto&& [name, node] : *table) place(find_key(*varied.section, name.str()), node);
}

class AxisReader {
 public:
  AxisReader(const toml::table& table, std::size_t number, Problems& problems)
      : table_(table), section_(fmt::format("axis.{}", number)), problems_(problems) {}

  ReadAxis read(const std::filesystem::path& folder, const std::optional<LatinHypercube>& sampling) {
    require_known_keys(table_, section_, {"key", "values", "names", "min", "max", "num", "scale", "seeds"},
                       problems_);
    const auto* key = table_["key"].as_string();
    if (key == nullptr) {
      bad("key", "the name of what varies, for example \"excitation.mu1\"");
      return {};
    }
    axis_.key = key->get();
    varied_ = find_varied(*key, axis_.key, problems_);
    if (varied_.section == nullptr) return {};
    const std::size_t before = problems_.size();
    const bool range = has("min") || has("max") || has("num") || has("scale");
    if (int(has("values")) + int(has("seeds")) + int(range) != 1) {
      problems_.add(table_.source(), section_ + " needs one of: values, min and max, seeds");
    } else if (has("values")) {
      read_values(folder);
    } else if (has("seeds")) {
      read_seeds();
    } else {
      read_range(sampling, std::stoul(section_.substr(section_.find('.') + 1)));
    }
    if (!has("values") && has("names"))
      problems_.add(table_.get("names")->source(), section_ + ".names belongs to values");
    if (problems_.size() != before) axis_.values.clear();
    return {std::move(axis_), std::move(nodes_)};
  }

 private:
  bool has(std::string_view name) const { return table_.contains(name); }

  void bad(std::string_view name, const std::string& required) {
    const toml::node* node = table_.get(name);
    problems_.add(node == nullptr ? table_.source() : node->source(),
                  node == nullptr
                      ? fmt::format("{}.{} is missing: {}", section_, name, required)
                      : fmt::format("{}.{} must be {}, not {}", section_, name, required, shown(*node)));
  }

  void read_values(const std::filesystem::path& folder) {
    const auto* values = table_["values"].as_array();
    if (values == nullptr || values->empty() || values->size() > most_runs)
      return bad("values", fmt::format("an array of 1 to {} values", most_runs));
    for (const toml::node& value : *values) {
      nodes_.push_back(value);
      place_paths(varied_, nodes_.back(), folder);
      axis_.values.push_back({json_of(value), place_of(value)});
      if (varied_.key == nullptr && !has("names")) {
        problems_.add(value.source(),
                      fmt::format("{}.names is missing: tables show values of \"{}\" by their names",
                                  section_, axis_.key));
        return;
      }
    }
    if (has("names")) read_names();
    std::set<std::string> seen, names;
    for (std::size_t n = 0; n < axis_.values.size(); ++n) {
      const AxisValue& value = axis_.values[n];
      if (!seen.insert(toml_value(nodes_[n])).second || !names.insert(value.shown.dump()).second)
        problems_.add(region_of(value.place),
                      fmt::format("{}: {} stands there twice", section_, value.shown.dump()));
    }
  }

  void read_names() {
    const auto* names = table_["names"].as_array();
    const bool texts = names != nullptr && names->size() == axis_.values.size() &&
                       std::ranges::all_of(*names, [](const toml::node& name) {
                         const auto text = name.value_exact<std::string>();
                         return text && !text->empty() && text->find_first_of("\r\n") == std::string::npos;
                       });
    if (!texts) return bad("names", fmt::format("{} names, one a value", axis_.values.size()));
    for (std::size_t n = 0; n < names->size(); ++n)
      axis_.values[n].shown = *names->get(n)->value<std::string>();
  }

  void read_seeds() {
    const auto count = table_["seeds"].value_exact<std::int64_t>();
    if (!count || *count < 1 || *count > std::int64_t(most_runs))
      return bad("seeds", fmt::format("a number of seeds, 1 to {}", most_runs));
    if (varied_.key == nullptr || varied_.key->name != "seed")
      return bad("key", "\"initial.seed\" where there are seeds");
    for (std::int64_t seed = 1; seed <= *count; ++seed) {
      nodes_.push_back(seed);
      axis_.values.push_back({seed, place_of(*table_.get("seeds"))});
    }
  }

  void read_range(const std::optional<LatinHypercube>& sampling, std::size_t number) {
    const auto finite = [&](std::string_view name) {
      const auto value = table_.get(name) != nullptr && table_.get(name)->is_number()
                             ? table_.get(name)->value<double>()
                             : std::nullopt;
      return value && std::isfinite(*value) ? value : std::nullopt;
    };
    const auto min = finite("min"), max = finite("max");
    if (!min) bad("min", "a number");
    if (!max) bad("max", "a number");
    const auto scale = has("scale") ? table_["scale"].value_exact<std::string>() : "linear";
    if (scale != "linear" && scale != "log") bad("scale", "\"linear\" or \"log\"");
    if (!min || !max) return;
    if (!(*min < *max)) return bad("max", fmt::format("above min = {}", *min));
    const bool log = scale == "log";
    if (log && *min <= 0) return bad("min", "above 0 on a log scale");
    axis_.sampled = !has("num");
    if (axis_.sampled && !sampling) {
      bad("num", "a number of values (or [latin_hypercube] says how many samples)");
      return;
    }
    if (axis_.sampled) return sample(*min, *max, log, *sampling, number);
    const auto num = table_["num"].value_exact<std::int64_t>();
    if (!num || *num < 2 || *num > std::int64_t(most_runs))
      return bad("num", fmt::format("a number of values, 2 to {}", most_runs));
    for (std::int64_t n = 0; n < *num; ++n)
      add_number(n + 1 == *num ? *max : between(*min, *max, log, double(n) / double(*num - 1)));
  }

  static double between(double min, double max, bool log, double part) {
    if (part == 0) return min;
    return rounded(log ? min * std::pow(max / min, part) : min + (max - min) * part);
  }

  // McKay, Beckman and Conover 1979: the parts in a random order, a random place in each. The standard fixes
  // the engine's numbers but leaves its distributions to each library.
  void sample(double min, double max, bool log, const LatinHypercube& sampling, std::size_t number) {
    std::seed_seq seeds{std::uint32_t(sampling.seed), std::uint32_t(sampling.seed >> 32),
                        std::uint32_t(number)};
    std::mt19937_64 engine(seeds);
    const auto uniform = [&engine] { return double(engine() >> 11) * 0x1p-53; };
    std::vector<std::size_t> parts(sampling.samples);
    std::iota(parts.begin(), parts.end(), std::size_t{0});
    for (std::size_t n = parts.size(); n > 1; --n)
      std::swap(parts[n - 1], parts[std::size_t(uniform() * double(n))]);
    for (const std::size_t part : parts)
      add_number(between(min, max, log, (double(part) + uniform()) / double(parts.size())));
  }

  void add_number(double value) {
    const bool integer = varied_.key != nullptr &&
                         (std::holds_alternative<Integer>(varied_.key->kind) ||
                          std::holds_alternative<Size>(varied_.key->kind)) &&
                         value == std::round(value) && std::abs(value) < 1e15;
    const Place place = place_of(*table_.get("min"));
    if (integer) {
      nodes_.push_back(std::int64_t(value));
      axis_.values.push_back({std::int64_t(value), place});
    } else {
      nodes_.push_back(value);
      axis_.values.push_back({value, place});
    }
  }

  const toml::table& table_;
  std::string section_;
  Problems& problems_;
  Varied varied_;
  SweepAxis axis_;
  toml::array nodes_;
};

}  // namespace

ReadAxis read_axis(const toml::table& table, const std::filesystem::path& folder,
                   const std::optional<LatinHypercube>& sampling, std::size_t number, Problems& problems) {
  return AxisReader(table, number, problems).read(folder, sampling);
}

}  // namespace myowave::apps
