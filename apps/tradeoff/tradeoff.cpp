#include "apps/tradeoff/tradeoff.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>
#include <set>
#include <system_error>
#include <utility>

#include "apps/base/device.hpp"
#include "apps/base/file_io.hpp"
#include "apps/base/memory.hpp"
#include "apps/base/signals.hpp"
#include "apps/input/presets.hpp"
#include "apps/input/scene_file.hpp"
#include "apps/input/scene_source.hpp"
#include "apps/input/schema.hpp"
#include "apps/results/run_folder.hpp"
#include "apps/tradeoff/tradeoff_output.hpp"
#include "solver/base/error.hpp"
#include "solver/run/stages.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;

std::string on_one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

std::string command_of(const TradeoffRequest& request) {
  std::string command = fmt::format("myowave tradeoff {}", request.scene);
  for (const auto& one : request.overrides) command += fmt::format(" --set {}", one);
  if (!request.axes.empty()) command += fmt::format(" --axes \"{}\"", request.axes);
  if (request.product) command += " --product";
  for (const auto& one : request.targets) command += fmt::format(" --target {}", one);
  if (request.refine_elements) command += " --refine-elements";
  if (request.budget) command += fmt::format(" --budget {}", *request.budget);
  return command + fmt::format(" --repetitions {} --levels {} --starts {}", request.repetitions,
                               request.levels, request.starts);
}

void require_counts(const TradeoffRequest& request) {
  if (request.repetitions < 1)
    throw solver::InputError(fmt::format("--repetitions must be at least 1, not {}", request.repetitions));
  if (request.starts < 1)
    throw solver::InputError(fmt::format("--starts must be at least 1, not {}", request.starts));
  if (request.budget && !(*request.budget > 0))
    throw solver::InputError(fmt::format("--budget must be seconds > 0, not {}", *request.budget));
}

// A scene and its overrides.
class Variants {
 public:
  explicit Variants(SceneSource source) : source_(std::move(source)) {}

  SceneSource source(const std::vector<std::string>& overrides) const {
    SceneSource source = source_;
    source.overrides.insert(source.overrides.end(), overrides.begin(), overrides.end());
    return source;
  }
  // Errors: InputError where it is not valid, not stable or does not fit the memory.
  solver::Scene scene(const std::vector<std::string>& overrides) const {
    solver::Scene scene = source(overrides).scene();
    solver::require_stable_step(scene);
    require_memory(scene);
    return scene;
  }
  // On grid.dx, whatever accuracy.dx the file has.
  solver::Scene own() const { return scene({"accuracy.dx=0"}); }

 private:
  SceneSource source_;
};

// What a setting comes to. Its preset only names it, and of accuracy.dx counts the grid that came of it.
std::string configuration_of(const solver::Scene& scene) {
  nlohmann::json configuration = effective_configuration(scene);
  for (const char* key : {"preset", "dx"}) configuration["accuracy"].erase(key);
  return configuration.dump();
}

// Each effective configuration once, those that the scene refuses with the reason.
std::vector<Trial> trials_of(const std::vector<Setting>& settings, const Variants& variants) {
  std::vector<Trial> trials;
  std::set<std::string> known;
  for (const Setting& setting : settings) {
    Trial trial{.setting = setting};
    try {
      trial.scene = variants.scene(setting.overrides);
      if (!known.insert(configuration_of(*trial.scene)).second) continue;
    } catch (const solver::InputError& refusal) {
      trial.trouble = on_one_line(fmt::format("refused: {}", refusal.what()));
    }
    trials.push_back(std::move(trial));
  }
  return trials;
}

void print_line(const std::string& line) { fmt::print(stderr, "{}\n", line); }

// The runs of one study, sequentially.
class Experiment {
 public:
  Experiment(Study& study, const Variants& variants, const TradeoffRequest& request)
      : study_(study),
        variants_(variants),
        request_(request),
        sampling_(sampling_of(study.own)),
        start_(start_of(study.own)) {}

  // Errors: NumericalFailure if no level reaches its end; Interrupted.
  void run_reference(const std::vector<int>& levels) {
    std::vector<int> done;
    std::vector<Measures> measures;
    for (const int k : levels) {
      ReferenceRun& run = study_.reference_runs.emplace_back(ReferenceRun{.k = k});
      run.overrides = reference_overrides(study_.own, k);
      try {
        const solver::Scene scene = reference_scene(k);
        MeasuredRun measured = measure(scene, start_, fmt::format("reference, dx / {}", k));
        run.wall_s = measured.wall_s;
        measures.push_back(std::move(measured.measures));
        done.push_back(k);
      } catch (const solver::NumericalFailure& failure) {
        run.trouble = on_one_line(fmt::format("failed: {}", failure.what()));
      } catch (const solver::InputError& refusal) {
        run.trouble = on_one_line(fmt::format("refused: {}", refusal.what()));
      }
      print_line(fmt::format("reference, dx / {}: {}", k,
                             run.trouble.empty() ? fmt::format("{:.3g} s", run.wall_s) : run.trouble));
    }
    if (measures.empty())
      throw solver::NumericalFailure(fmt::format("no level of the reference reached its end; the last one {}",
                                                 study_.reference_runs.back().trouble));
    std::vector<Measures> from_starts;
    if (is_chaotic(measures)) {
      make_starts();
      from_starts = run_starts(done.front());
    }
    study_.reference = make_reference(std::move(done), measures, from_starts);
  }

  // Interleaved: each round runs all settings in another order, so that a drift of the machine's speed
  // affects all alike. The rounds of a chaotic scene are its starts. Errors: Interrupted.
  void run_settings() {
    std::mt19937 engine(20040601);
    double spent = 0;
    const int rounds = starts_.empty() ? request_.repetitions : request_.starts;
    for (int round = 0; round < rounds; ++round) {
      std::vector<Trial*> order;
      for (Trial& trial : study_.trials)
        if (trial.scene && trial.trouble.empty()) order.push_back(&trial);
      for (std::size_t n = order.size(); n > 1; --n) std::swap(order[n - 1], order[engine() % n]);
      // All speeds are against it, so that a budget leaves out others first.
      if (round == 0)
        std::ranges::partition(order, [](const Trial* trial) { return trial->setting.name == "paper"; });
      for (Trial* trial : order) {
        if (request_.budget && spent >= *request_.budget) {
          if (round == 0) trial->trouble = "left out: the budget was spent";
          continue;
        }
        run_trial(*trial, starts_.empty() ? start_ : starts_[round]);
        if (!trial->wall_s.empty()) spent += trial->wall_s.back();
      }
    }
  }

 private:
  // With the elements of the scene, or k times smaller ones.
  solver::Scene reference_scene(int k) const {
    solver::Scene scene = variants_.scene(reference_overrides(study_.own, k));
    if (scene.mechanics && request_.refine_elements)
      scene.mechanics->cells_per_element = study_.own.mechanics->cells_per_element;
    return scene;
  }

  // Of a chaotic scene, from noise.
  void make_starts() {
    constexpr const char* noise = "initial.noise=1e-3";
    for (int seed = 1; seed <= request_.starts; ++seed)
      starts_.push_back(
          start_of(variants_.scene({"accuracy.dx=0", noise, fmt::format("initial.seed={}", seed)})));
  }

  std::vector<Measures> run_starts(int k) {
    std::vector<Measures> measures;
    for (std::size_t n = 0; n < starts_.size(); ++n) {
      const std::string name = fmt::format("reference, dx / {}, start {} of {}", k, n + 1, starts_.size());
      MeasuredRun measured = measure(reference_scene(k), starts_[n], name);
      print_line(fmt::format("{}: {:.3g} s", name, measured.wall_s));
      measures.push_back(std::move(measured.measures));
    }
    return measures;
  }

  // The scene itself and the plane wave.
  MeasuredRun measure(const solver::Scene& scene, const solver::InitialState& start,
                      const std::string& name) {
    MeasuredRun run = measure_scene(scene, start, study_.own.grid, sampling_, name);
    run.measures.numbers.merge(measure_plane_wave(scene).numbers);
    return run;
  }

  void run_trial(Trial& trial, const solver::InitialState& start) {
    const std::string& name = trial.setting.name;
    try {
      MeasuredRun run = trial.runs.empty()
                            ? measure(*trial.scene, start, name)
                            : measure_scene(*trial.scene, start, study_.own.grid, sampling_, name);
      if (trial.runs.empty() || !starts_.empty()) trial.runs.push_back(std::move(run.measures));
      trial.wall_s.push_back(run.wall_s);
      trial.cell_steps_per_s.push_back(run.cell_steps_per_s);
      print_line(fmt::format("{}: {:.3g} s", name, run.wall_s));
    } catch (const solver::NumericalFailure& failure) {
      trial.trouble = on_one_line(fmt::format("failed: {}", failure.what()));
    } catch (const solver::InputError& refusal) {
      trial.trouble = on_one_line(fmt::format("refused: {}", refusal.what()));
    }
    if (!trial.trouble.empty()) print_line(fmt::format("{}: {}", name, trial.trouble));
  }

  Study& study_;
  const Variants& variants_;
  const TradeoffRequest& request_;
  Sampling sampling_;
  solver::InitialState start_;
  std::vector<solver::InitialState> starts_;  // of a chaotic scene
};

void run_all(Study& study, const Variants& variants, const TradeoffRequest& request,
             const std::vector<int>& levels) {
  try {
    Experiment experiment(study, variants, request);
    experiment.run_reference(levels);
    experiment.run_settings();
  } catch (const solver::Interrupted& stopped) {
    study.stopped = fmt::format("stopped on request: {}", stopped.what());
  } catch (const solver::NumericalFailure& failure) {
    study.stopped = failure.what();
  }
  if (!study.reference) return;
  for (Trial& trial : study.trials)
    if (!trial.runs.empty()) trial.errors = errors_of(trial.runs, *study.reference);
}

std::string targets_text(const std::vector<ErrorTarget>& targets) {
  std::vector<std::string> texts;
  for (const auto& [name, largest] : targets)
    texts.push_back(fmt::format("{} <= {:g} {}", name, largest, find_observable(name)->unit));
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string errors_text(const Errors& errors, const std::vector<ErrorTarget>& targets) {
  std::vector<std::string> texts;
  for (const auto& [name, largest] : targets)
    texts.push_back(
        fmt::format("{} {:.3g} {}", name, errors.find(name)->second.value, find_observable(name)->unit));
  return fmt::format("{}", fmt::join(texts, ", "));
}

// A target below the uncertainty of the reference cannot be verified.
void warn_of_uncertainty(const Study& study, const std::vector<ErrorTarget>& targets) {
  for (const auto& [name, largest] : targets) {
    const auto value = study.reference->values.find(name);
    if (value == study.reference->values.end()) continue;
    if (!(value->second.uncertainty <= largest))
      print_line(fmt::format("myowave: --target {}: the reference is itself uncertain by {:.2g} {}", name,
                             value->second.uncertainty, find_observable(name)->unit));
  }
}

// Writes target.toml. Errors: NumericalFailure if no setting meets the targets.
void write_target(const Study& study, const Variants& variants, const std::vector<ErrorTarget>& targets,
                  const fs::path& file) {
  std::vector<Candidate> candidates;
  std::vector<const Trial*> of;
  for (const Trial& trial : study.trials) {
    if (trial.wall_s.empty()) continue;
    candidates.push_back({median(trial.wall_s), trial.errors});
    of.push_back(&trial);
  }
  warn_of_uncertainty(study, targets);
  const auto chosen = choose(candidates, targets);
  if (!chosen) {
    const auto nearest = nearest_to(candidates, targets);
    throw solver::NumericalFailure(
        fmt::format("no setting meets {}; {}", targets_text(targets),
                    nearest ? fmt::format("the nearest is \"{}\": {}", of[*nearest]->setting.name,
                                          errors_text(candidates[*nearest].errors, targets))
                            : "no setting has all of these errors: the scene lacks what they measure"));
  }
  const Trial& trial = *of[*chosen];
  const SceneSource source = variants.source(trial.setting.overrides);
  const std::string text = fmt::format("# {} with the setting \"{}\" of myowave tradeoff: {}.\n\n{}",
                                       study.own.name, trial.setting.name, errors_text(trial.errors, targets),
                                       overridden_text(source.text, source.file, source.overrides));
  parse_scene(text, file);
  replace_file(file, text);
  fmt::print("target   {}: \"{}\", {:.3g} s; {}\n", targets_text(targets), trial.setting.name,
             median(trial.wall_s), file.string());
}

}  // namespace

void tradeoff(const TradeoffRequest& request) {
  if (request.scene.empty() || request.out.empty())
    throw solver::InputError("SCENE and --out DIR are required, or --list");
  require_counts(request);
  const auto levels = parse_levels(request.levels);
  const auto targets = parse_targets(request.targets);
  const Variants variants(read_source(request.scene, request.overrides));
  Study study{.command = command_of(request), .own = variants.own()};
  study.trials = trials_of(make_settings(parse_axes(request.axes, study.own), request.product), variants);
  const fs::path folder = request.out;
  RunFolder::require_free(folder, request.force);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw solver::InputError(
        fmt::format("cannot make the result folder {}: {}", folder.string(), error.message()));
  remove_tradeoff(folder);

  watch_signals();
  const Device device;
  run_all(study, variants, request, levels);
  write_tradeoff(study, folder);
  print_tradeoff(study);
  fmt::print("results  {}\n", (folder / "index.html").string());
  if (stop_requested())
    throw solver::Interrupted(fmt::format("stopped; what was measured until then is in {}", folder.string()));
  if (!study.reference) throw solver::NumericalFailure(study.stopped);
  if (!targets.empty()) write_target(study, variants, targets, folder / "target.toml");
}

void list_dials() {
  fmt::print("dials\n");
  for (const Dial& dial : dials())
    fmt::print("  {:<28}{}{}\n  {:28}{}\n", dial.key, dial.doc, dial.elastic ? " (not of a rigid sheet)" : "",
               "", dial.values);
  fmt::print("presets\n");
  for (const Preset& preset : presets())
    if (!preset.values.empty()) fmt::print("  {:<12}{}\n", preset.name, values_text(preset));
}

}  // namespace myowave::apps
