#include "apps/results/run_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "apps/base/file_io.hpp"
#include "apps/base/progress_line.hpp"
#include "apps/draw/frame_picture.hpp"
#include "apps/results/fields_file.hpp"
#include "apps/results/manifest.hpp"
#include "apps/results/maps_file.hpp"
#include "apps/results/summary_file.hpp"
#include "apps/results/xdmf_file.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;

// Files of an earlier run. Nothing else in the folder is touched.
constexpr std::array file_names{"summary.json", "manifest.json", "fields.h5",         "fields.xdmf",
                                "probes.csv",   "beats.csv",     "tips.csv",          "trajectories.csv",
                                "sources.csv",  "area.csv",      "element_areas.csv", "maps.h5"};

bool is_frame(const fs::path& path) {
  return path.extension() == ".png" && path.filename().string().starts_with("frame_");
}

// Of a run that was killed while it wrote beside a file that it would have replaced.
bool is_left_over(const fs::path& path) {
  const std::string name = path.filename().string();
  return path.extension() == ".tmp" &&
         (name.starts_with("frame_") ||
          std::ranges::any_of(file_names, [&](const char* file) { return name.starts_with(file); }));
}

void remove_left_overs(const fs::path& folder) {
  for (const auto& place : {folder, folder / "frames"}) {
    std::error_code missing;
    for (const auto& entry : fs::directory_iterator(place, missing))
      if (is_left_over(entry.path())) fs::remove(entry.path());
  }
}

void remove_results(const fs::path& folder) {
  remove_left_overs(folder);
  for (const char* name : file_names) fs::remove(folder / name);
  fs::remove_all(folder / checkpoints_name);
  const fs::path frames = folder / "frames";
  if (!fs::is_directory(frames)) return;
  for (const auto& entry : fs::directory_iterator(frames)) {
    if (is_frame(entry.path())) fs::remove(entry.path());
  }
}

// An error of the file system is the user's to mend.
template <class Action>
void with_folder(const fs::path& folder, const Action& action) {
  try {
    action();
  } catch (const fs::filesystem_error& error) {
    throw solver::InputError(
        fmt::format("cannot make the result folder {}: {}", folder.string(), error.code().message()));
  }
}

std::string probes_header(const solver::OutputSettings& output) {
  std::string header = "t";
  for (std::size_t n = 0; n < output.probes.size(); ++n) header += fmt::format(",V{0},r{0},Ta{0}", n);
  return header + '\n';
}

std::string element_areas_header(const FrameShape& shape) {
  std::string header = "t";
  for (int e = 0; e < shape.element_rows() * shape.element_columns(); ++e) header += fmt::format(",A{}", e);
  return header + '\n';
}

// Held by one run at a time. The system releases it when the process ends, however it ends.
class FolderLock {
 public:
  // Errors: InputError where another run has it.
  explicit FolderLock(const fs::path& folder)
      : folder_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (folder_ < 0 || flock(folder_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    close(folder_);
    throw solver::InputError(fmt::format("{}: another run is at work in this folder", folder.string()));
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock() {
    if (folder_ >= 0) close(folder_);
  }

 private:
  int folder_;
};

}  // namespace

struct RunFolder::Impl {
  // mark: null for a new folder.
  Impl(fs::path path, std::unique_ptr<FolderLock> its_lock, const solver::Scene& scene,
       const nlohmann::json& mark, bool quiet)
      : folder(std::move(path)),
        lock(std::move(its_lock)),
        shape(frame_shape(scene)),
        probes(text_file("probes.csv", probes_header(scene.output), mark)),
        tips(text_file("tips.csv", "t,x,y,charge,trajectory\n", mark)),
        trajectories(
            text_file("trajectories.csv",
                      "trajectory,charge,birth_tu,death_tu,born,ended,core_x,core_y,core_radius,drift_speed,"
                      "drift_direction,boundary_tu\n",
                      mark)),
        sources(text_file("sources.csv", "t,sources\n", mark)),
        beats(text_file("beats.csv", "probe,upstroke_tu,period_tu,apd_tu,apd90_tu,di_tu\n", mark)),
        area(text_file("area.csv", "t,area,area_min,area_max\n", mark)),
        progress(scene.time.ms_per_tu, quiet) {
    if (scene.output.fields) open_fields(scene, mark);
    if (has_element_areas(scene))
      element_areas.emplace(text_file("element_areas.csv", element_areas_header(shape), mark));
    if (scene.output.frames) {
      fs::create_directories(folder / "frames");
      picture.emplace(scene);
      if (!mark.is_null()) pictures = synced_pictures = mark.at("frames");
    }
  }

  AppendedFile text_file(const char* name, const std::string& header, const nlohmann::json& mark) const {
    if (mark.is_null()) return {folder / name, header};
    return {folder / name, mark.at("bytes").at(name).get<std::uintmax_t>()};
  }

  void open_fields(const solver::Scene& scene, const nlohmann::json& mark) {
    const fs::path path = folder / "fields.h5", description = folder / "fields.xdmf";
    const double ms_per_tu = scene.time.ms_per_tu;
    // The first, those that are due, the last.
    const auto expected = static_cast<std::size_t>(std::min(1e9, scene.time.t_end / scene.output.every)) + 2;
    if (mark.is_null()) {
      fields.emplace(path, shape, ms_per_tu, expected);
      xdmf.emplace(description, shape, "fields.h5");
    } else {
      fields.emplace(path, shape, ms_per_tu, expected,
                     FieldsFile::Saved{mark.at("fields").at("frames"), mark.at("fields").at("digest")});
      xdmf.emplace(description, shape, "fields.h5", mark.at("bytes").at("fields.xdmf").get<std::uintmax_t>());
    }
  }

  nlohmann::json saved_fields() const {
    if (!fields) return nullptr;
    return {{"frames", fields->saved().frames}, {"digest", fields->saved().digest}};
  }

  fs::path picture_path(std::size_t number) const {
    return folder / "frames" / fmt::format("frame_{:05}.png", number);
  }

  // On the disk, all of it.
  nlohmann::json mark() {
    nlohmann::json bytes;
    for (AppendedFile* file : {&probes, &tips, &trajectories, &sources, &beats, &area})
      bytes[file->path().filename().string()] = file->sync();
    if (element_areas) bytes["element_areas.csv"] = element_areas->sync();
    if (fields) {
      fields->sync();
      bytes["fields.xdmf"] = xdmf->sync();
    }
    for (; synced_pictures < pictures; ++synced_pictures) sync_file(picture_path(synced_pictures));
    return {{"bytes", bytes}, {"fields", saved_fields()}, {"frames", pictures}};
  }

  fs::path folder;
  std::unique_ptr<FolderLock> lock;
  FrameShape shape;
  AppendedFile probes, tips, trajectories, sources, beats, area;
  std::optional<AppendedFile> element_areas;
  std::optional<FieldsFile> fields;
  std::optional<XdmfFile> xdmf;
  std::optional<FramePicture> picture;
  std::size_t pictures = 0, synced_pictures = 0;
  ProgressLine progress;
};

void RunFolder::require_free(const fs::path& folder, bool force) {
  with_folder(folder, [&] {
    if (!fs::exists(folder)) return;
    if (!fs::is_directory(folder)) {
      throw solver::InputError(
          fmt::format("{} is a file; the results need a folder: choose another with --out", folder.string()));
    }
    if (!force && !fs::is_empty(folder)) {
      throw solver::InputError(
          fmt::format("the result folder {} is there already: choose another with --out, or replace its "
                      "results with --force",
                      folder.string()));
    }
  });
}

RunFolder::RunFolder(fs::path folder, const solver::Scene& scene, bool force, bool quiet) {
  require_free(folder, force);
  with_folder(folder, [&] { fs::create_directories(folder); });
  auto lock = std::make_unique<FolderLock>(folder);
  with_folder(folder, [&] { remove_results(folder); });
  try {
    impl_ = std::make_unique<Impl>(std::move(folder), std::move(lock), scene, nullptr, quiet);
  } catch (const std::runtime_error& error) {
    throw solver::InputError(error.what());
  }
}

RunFolder::RunFolder(fs::path folder, const solver::Scene& scene, const std::string& mark, bool quiet) {
  auto lock = std::make_unique<FolderLock>(folder);
  try {
    remove_left_overs(folder);
    impl_ =
        std::make_unique<Impl>(std::move(folder), std::move(lock), scene, nlohmann::json::parse(mark), quiet);
  } catch (const nlohmann::json::exception& error) {
    throw solver::InputError(
        fmt::format("the checkpoint's mark of the outputs cannot be read: {}", error.what()));
  } catch (const std::runtime_error& error) {
    throw solver::InputError(error.what());
  }
}

RunFolder::~RunFolder() = default;

void RunFolder::write_manifest(const nlohmann::json& effective_configuration) {
  replace_file(impl_->folder / "manifest.json", manifest_json(effective_configuration).dump(2) + '\n');
}

void RunFolder::write_summary(const solver::RunSummary& summary, const std::optional<std::string>& failure) {
  impl_->progress.end();
  replace_file(impl_->folder / "summary.json",
               summary_json(summary, impl_->shape.deforms(), failure).dump(2) + '\n');
}

void RunFolder::fields(const solver::Frame& frame) {
  if (impl_->fields) {
    impl_->fields->append(frame);
    impl_->xdmf->append(impl_->fields->frames() - 1, frame.t);
  }
  if (impl_->picture) {
    replace_file(impl_->picture_path(impl_->pictures), impl_->picture->draw(frame).png());
    ++impl_->pictures;
  }
}

void RunFolder::probes(double t, std::span<const double> values) {
  std::string row = fmt::format("{}", t);
  for (std::size_t n = 0; n < values.size(); ++n) {
    const bool is_tension = n % 3 == 2;
    row += is_tension && !impl_->shape.tension ? "," : fmt::format(",{}", values[n]);
  }
  impl_->probes.append(row + '\n');
}

void RunFolder::tips(double t, std::span<const solver::Tip> tips) {
  std::string rows;
  for (const auto& tip : tips) {
    const std::string number = tip.trajectory < 0 ? "" : fmt::format("{}", tip.trajectory);
    rows += fmt::format("{},{},{},{},{}\n", t, tip.x, tip.y, tip.charge, number);
  }
  impl_->tips.append(rows);
  impl_->sources.append(fmt::format("{},{}\n", t, tips.size()));
}

void RunFolder::trajectory(const solver::TipTrajectory& one) {
  const auto cell = [](const std::optional<double>& value) { return value ? fmt::format("{}", *value) : ""; };
  const std::string core =
      one.core ? fmt::format("{},{},{}", one.core->x, one.core->y, one.core->radius) : ",,";
  const std::string drift = one.drift ? fmt::format("{},{}", one.drift->speed, one.drift->direction) : ",";
  impl_->trajectories.append(fmt::format("{},{},{},{},{},{},{},{},{}\n", one.number, one.charge, one.birth,
                                         one.death, event_name(one.born, "start"),
                                         event_name(one.ended, "end"), core, drift, cell(one.boundary)));
}

void RunFolder::beat(const solver::ProbeBeat& one) {
  const auto cell = [](double value) { return std::isnan(value) ? std::string() : fmt::format("{}", value); };
  const solver::Beat& beat = one.beat;
  impl_->beats.append(fmt::format("{},{},{},{},{},{}\n", one.probe, beat.upstroke, cell(beat.period),
                                  cell(beat.apd), cell(beat.apd90), cell(beat.di)));
}

void RunFolder::area(double t, double total, double min, double max) {
  impl_->area.append(fmt::format("{},{},{},{}\n", t, total, min, max));
}

void RunFolder::element_areas(double t, std::span<const double> ratios) {
  impl_->element_areas->append(fmt::format("{},{}\n", t, fmt::join(ratios, ",")));
}

void RunFolder::maps(const solver::ActivationMaps& maps) { write_maps(impl_->folder / "maps.h5", maps); }

void RunFolder::progress(const solver::Progress& progress) { impl_->progress.show(progress); }

void RunFolder::warning(const std::string& text) {
  impl_->progress.end();
  fmt::print(stderr, "myowave: warning: {}\n", text);
}

std::string RunFolder::mark() { return impl_->mark().dump(); }

bool RunFolder::wants_fields() const { return impl_->fields || impl_->picture; }

}  // namespace myowave::apps
