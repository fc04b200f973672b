#include "apps/report/movie.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <memory>
#include <system_error>

#include "apps/draw/frame_picture.hpp"

namespace myowave::apps {
namespace {

constexpr int pictures_per_second = 24;

// A process that reads from a pipe.
class Encoder {
 public:
  explicit Encoder(std::vector<std::string> arguments) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    started_ = posix_spawnp(&process_, argv[0], &actions, nullptr, argv.data(), environ) == 0;
    posix_spawn_file_actions_destroy(&actions);
    close(ends[0]);
    input_.reset(fdopen(ends[1], "wb"));
  }

  bool started() const { return started_ && input_; }

  bool write(const Picture& picture) {
    const std::size_t pixels = std::size_t(picture.width()) * std::size_t(picture.height());
    return std::fwrite(&picture.at(0, 0), sizeof(Colour), pixels, input_.get()) == pixels;
  }

  // Whether it ended well.
  bool finish() {
    input_.reset();
    int status = -1;
    return waitpid(process_, &status, 0) == process_ && WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  pid_t process_ = 0;
  bool started_ = false;
  std::unique_ptr<std::FILE, Close> input_;
};

// What FramePicture asks of a scene.
solver::Scene scene_of(const ReportRun& run, const StoredFrame& frame, double every) {
  solver::Scene scene;
  scene.grid = {frame.shape.rows, frame.shape.columns, frame.shape.dx};
  scene.time.ms_per_tu = run.ms_per_tu();
  scene.output.every = every;
  if (frame.shape.deforms()) {
    auto& mechanics = scene.mechanics.emplace();
    const nlohmann::json configuration = run.configuration();
    const auto given = configuration.is_object() ? configuration.value("mechanics", nlohmann::json::object())
                                                 : nlohmann::json::object();
    mechanics.cells_per_element = frame.shape.cells;
    mechanics.c1 = given.value("c1", mechanics.c1);
    mechanics.c2 = given.value("c2", mechanics.c2);
    mechanics.p = given.value("p", mechanics.p);
    if (given.value("load", "") == "dead") mechanics.load = solver::Load::dead;
    if (given.value("edges", "") == "fixed") mechanics.edges = solver::Edges::fixed;
  }
  return scene;
}

}  // namespace

std::string write_movie(const ReportRun& run, const std::filesystem::path& file) {
  const auto times = run.results().frame_times();
  if (times.empty()) return "no movie: the run has no frames in fields.h5 (output.fields = true)";
  const double every = times.size() > 1 ? times[1] - times[0] : 1;
  const FramePicture drawing(scene_of(run, run.results().frame(0), every));
  const auto draw = [&](std::size_t n) {
    const StoredFrame stored = run.results().frame(n);
    solver::Frame frame;
    frame.t = stored.t;
    frame.rows = stored.shape.rows;
    frame.columns = stored.shape.columns;
    frame.V = stored.V;
    frame.nodes = stored.nodes;
    return drawing.draw(frame);
  };
  const Picture first = draw(0);
  std::signal(SIGPIPE, SIG_IGN);  // the status reports an encoder that ends early
  Encoder encoder({"ffmpeg",
                   "-nostdin",
                   "-loglevel",
                   "error",
                   "-y",
                   "-f",
                   "rawvideo",
                   "-pixel_format",
                   "rgb24",
                   "-video_size",
                   fmt::format("{}x{}", first.width(), first.height()),
                   "-framerate",
                   fmt::format("{}", pictures_per_second),
                   "-i",
                   "pipe:0",
                   "-c:v",
                   "libx264",
                   "-pix_fmt",
                   "yuv420p",
                   "-movflags",
                   "+faststart",
                   "file:" + file.string()});
  if (!encoder.started()) return "no movie: ffmpeg is not installed";
  bool taken = encoder.write(first);
  for (std::size_t n = 1; taken && n < times.size(); ++n) taken = encoder.write(draw(n));
  return encoder.finish() && taken ? "" : "no movie: ffmpeg failed";
}

}  // namespace myowave::apps
