// The files of a run; file names and columns are a contract (apps/results/README.md).
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "solver/base/run_output.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::apps {

// Errors of all writes: std::runtime_error that names the file and the reason.
// The folder of a run's checkpoints in its result folder (solver/run/checkpoint.hpp).
inline constexpr const char* checkpoints_name = "checkpoints";

class RunFolder final : public solver::OutputSink {
 public:
  // Errors: InputError where the folder holds something and `force` is false.
  static void require_free(const std::filesystem::path& folder, bool force);

  // Creates the folder; `force` replaces the results in one that is there and leaves all else in it.
  // Errors: InputError where it holds something and `force` is false, or cannot be written.
  RunFolder(std::filesystem::path folder, const solver::Scene&, bool force, bool quiet);
  // Resumes a folder from a mark: everything after it is cut off.
  // Errors: InputError if a file of the mark is missing or shorter, or if the mark is invalid.
  RunFolder(std::filesystem::path folder, const solver::Scene&, const std::string& mark, bool quiet);
  ~RunFolder() override;

  void write_manifest(const nlohmann::json& effective_configuration);
  // `failure`: the error that ended the run early. May be called more than once.
  void write_summary(const solver::RunSummary&, const std::optional<std::string>& failure);

  void fields(const solver::Frame&) override;
  void probes(double t, std::span<const double>) override;
  void tips(double t, std::span<const solver::Tip>) override;
  void trajectory(const solver::TipTrajectory&) override;
  void beat(const solver::ProbeBeat&) override;
  void area(double t, double total, double min, double max) override;
  void element_areas(double t, std::span<const double>) override;
  void maps(const solver::ActivationMaps&) override;
  void progress(const solver::Progress&) override;
  void warning(const std::string&) override;
  bool wants_fields() const override;
  std::string mark() override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace myowave::apps
