// report.html of folders made by hand: shows what exists, reports what is missing or broken.
#include "apps/report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/report/report_run.hpp"
#include "solver/base/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace myowave::apps {
namespace {

namespace fs = std::filesystem;
using test::read_text;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

// The parts of a finished run that tests read.
void write_run(const fs::path& folder, double mu1 = 0.12) {
  write(folder / "summary.json", R"({"t": 40, "failure": null, "warnings": ["</script><b>"], "wall_s": 2,
    "plan": [{"part": "sheet", "active": true, "what": "flat & thin", "why": ""},
             {"part": "mechanics", "active": false, "what": "", "why": "rigid"}],
    "phases": {"excitation": 1.5}, "throughput": {"cell_steps_per_s": 5e8}, "mechanics": null,
    "memory": {"planned_bytes": {"Cuda": 1572864, "Host": 900}, "most_bytes": {"Cuda": 2097152}},
    "observables": {"period": {"mean": 26.82, "sd": 0.37, "n": 9}, "core": {"radius": 1.77, "drift_speed": 0.05},
                    "breakup_tu": 17, "death_tu": null,
                    "tips": {"mean": )" +
                                     std::to_string(100 * mu1) + R"(, "sd": 1}}})");
  write(folder / "manifest.json", R"({"configuration": {"excitation": {"mu1": )" + std::to_string(mu1) +
                                      R"(}, "time": {"ms_per_tu": 20.0}, "output": {"probes": [[3, 4]]}}})");
  write(folder / "probes.csv", "t,V0,r0,Ta0\n0,0,0,\n1,0.5,0,\n2,1,0,\n");
  write(folder / "tips.csv", "t,x,y,charge,trajectory\n1,1,1,1,0\n1,2,2,-1,1\n2,1,1.5,1,0\n");
  write(folder / "area.csv", "t,area,area_min,area_max\n0,1,1,1\n");
  write(folder / "beats.csv",
        "probe,upstroke_tu,period_tu,apd_tu,apd90_tu,di_tu\n0,1,25,20,19,6\n0,26,24,18,17,7\n0,50,,16,,\n");
}

const NamedPlot& plot_of(const std::vector<NamedPlot>& plots, const std::string& name) {
  const auto found = std::ranges::find(plots, name, &NamedPlot::name);
  if (found == plots.end()) throw std::runtime_error("no plot " + name);
  return *found;
}

std::string page_of(const TemporaryFolder& folder, const std::vector<std::string>& runs) {
  ReportRequest request;
  for (const auto& run : runs) request.folders.push_back(folder / run);
  request.out = folder / "page/report.html";
  testing::internal::CaptureStdout();
  report(request);
  testing::internal::GetCapturedStdout();
  return read_text(request.out);
}

TEST(ReportRun, HasTheNumbersWithTheirUnits) {
  const TemporaryFolder folder;
  write_run(folder / "a");
  const auto facts = ReportRun(folder / "a").numbers();
  std::vector<std::string> texts;
  for (const Fact& fact : facts) texts.push_back(fact.what + " = " + fact.value);
  EXPECT_THAT(texts,
              ElementsAre("reached = 40 t.u. (800 ms)", "period = 26.82 ± 0.37 t.u. (536.4 ± 7.4 ms), n = 9",
                          "core: drift speed = 0.05 length units/t.u.", "core: radius = 1.77 length units",
                          "breakup = 17 t.u. (340 ms)", "tips = 12 ± 1"));
}

TEST(ReportRun, NamesOnlyParametersThatDiffer) {
  const TemporaryFolder folder;
  write_run(folder / "a", 0.07);
  std::vector<std::string> keys;
  for (const auto& one : ReportRun(folder / "a").changed_parameters()) keys.push_back(one.key);
  EXPECT_THAT(keys, ElementsAre("excitation.mu1", "output.probes", "time.ms_per_tu"));
}

TEST(ReportRun, PlotsInSecondsAndMilliseconds) {
  const TemporaryFolder folder;
  write_run(folder / "a");
  const auto plots = ReportRun(folder / "a").plots();
  const Plot& V = plot_of(plots, "probes_V").plot;
  EXPECT_EQ(V.series[0].name, "row 3, column 4");
  EXPECT_EQ(V.series[0].x[2], 2 * 0.020);
  EXPECT_TRUE(std::ranges::none_of(plots, [](const auto& one) { return one.name == "probes_Ta"; }));
  EXPECT_THAT(plot_of(plots, "tips").plot.series[0].y, ElementsAre(2, 1));
  const Plot& tips = plot_of(plots, "trajectories").plot;
  EXPECT_TRUE(tips.equal_scales);
  EXPECT_EQ(tips.series.size(), 2u) << "one of each charge";
  EXPECT_THAT(plot_of(plots, "periods").plot.series[0].y, ElementsAre(500, 480));
  // Each APD against the interval before it: the first and the last have none.
  const Series& restitution = plot_of(plots, "restitution").plot.series[0];
  EXPECT_THAT(restitution.x, ElementsAre(120));
  EXPECT_THAT(restitution.y, ElementsAre(340));
}

TEST(Report, SweepsShowWhatDependsOnTheNumberThatVaries) {
  const TemporaryFolder folder;
  std::vector<ReportRun> runs;
  for (const double mu1 : {0.07, 0.09, 0.12}) {
    const auto run = folder / std::to_string(mu1);
    write_run(run, mu1);
    runs.emplace_back(run);
  }
  const auto plots = sweep_plots(runs);
  EXPECT_THAT(plot_of(plots, "sweep_tips").plot.series[0].x, ElementsAre(0.07, 0.09, 0.12));
  EXPECT_THAT(plot_of(plots, "sweep_tips").plot.series[0].y, ElementsAre(7, 9, 12));
  EXPECT_EQ(plot_of(plots, "sweep_tips").plot.x.label, "excitation.mu1");
}

TEST(Report, IsOnePageWhoseTextIsEscaped) {
  const TemporaryFolder folder;
  write_run(folder / "<script>evil");
  const std::string page = page_of(folder, {"<script>evil"});
  EXPECT_THAT(page, Not(HasSubstr("<script>evil")));
  EXPECT_THAT(page, HasSubstr("<h1>&lt;script&gt;evil</h1>"));
  EXPECT_THAT(page, HasSubstr("Warning: &lt;/script&gt;&lt;b&gt;"));
  EXPECT_THAT(page, HasSubstr("flat &amp; thin"));
  EXPECT_THAT(page, HasSubstr("wrote no fields.h5"));
  EXPECT_THAT(page, HasSubstr("75.0 %")) << "share of the excitation in the time";
  EXPECT_THAT(page, HasSubstr("memory, Cuda</th><td>2.0 MiB allocated, 1.5 MiB estimated</td>"));
  EXPECT_THAT(page, HasSubstr("memory, Host</th><td>900 B estimated</td>")) << "what was not measured";
  for (const char* file : {"probes_V.svg", "probes_V.png", "restitution.svg"})
    EXPECT_TRUE(fs::exists(folder / "page/plots" / file)) << file;
}

TEST(Report, SeveralRunsStandSideBySide) {
  const TemporaryFolder folder;
  write_run(folder / "a", 0.07);
  write_run(folder / "b", 0.12);
  const std::string page = page_of(folder, {"a", "b"});
  EXPECT_THAT(page,
              HasSubstr("<th scope=\"row\"><code>excitation.mu1</code></th><td>0.07</td><td>0.12</td>"));
  EXPECT_THAT(page, HasSubstr("<h2 id=\"run-1\">b</h2>"));
  EXPECT_TRUE(fs::exists(folder / "page/plots/1_probes_V.svg"));
}

// Periods 25, 24 against 29, 28: t = 4 / sqrt(1/2 (1/2 + 1/2)), two degrees of freedom, p = 0.0299.
TEST(Report, TestsWhetherTwoRunsDiffer) {
  const TemporaryFolder folder;
  write_run(folder / "a");
  write_run(folder / "b");
  write(folder / "b/beats.csv", "probe,upstroke_tu,period_tu\n0,1,29\n0,30,28\n");
  EXPECT_THAT(page_of(folder, {"b", "a"}), HasSubstr("difference +4.00; unpaired t-test p = 0.03;"));
  EXPECT_THAT(page_of(folder, {"a"}), Not(HasSubstr("unpaired t-test")));
}

TEST(Report, ShowsWhatIsMissingOrTruncated) {
  const TemporaryFolder folder;
  write_run(folder / "a");
  fs::remove(folder / "a/summary.json");
  write(folder / "a/probes.csv", "t,V0,r0,Ta0\n0,0,0,\n1,0.5");
  write(folder / "a/area.csv", "nonsense\n");
  write(folder / "a/fields.h5", "nothing that HDF5 knows");
  const std::string page = page_of(folder, {"a"});
  EXPECT_THAT(page, HasSubstr("The run is not finished"));
  EXPECT_THAT(page, HasSubstr("probes.csv: 1 row is cut off and left out."));
  EXPECT_THAT(page, HasSubstr("area.csv is left out: it has no column t."));
  EXPECT_THAT(page, HasSubstr("fields.h5 cannot be read"));
}

TEST(Report, RefusesAFolderWithoutARun) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "empty");
  write(folder / "broken/manifest.json", "{");
  for (const auto& [name, reason] :
       {std::pair{"empty", "there is no manifest.json, summary.json or reproduction.json"},
        {"nowhere", "there is no such folder"},
        {"broken", "manifest.json"}}) {
    try {
      page_of(folder, {name});
      ADD_FAILURE() << name;
    } catch (const solver::InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(reason));
    }
    testing::internal::GetCapturedStdout();
  }
}

TEST(Report, ShowsAReproduction) {
  const TemporaryFolder folder;
  write(folder / "r/fig01.png", "foo");
  write(folder / "r/reproduction.json", R"({"figures": [
    {"name": "fig01", "title": "Figure 1: <restitution>", "png": "fig01.png",
     "rows": [{"what": "APD", "paper": "25.58", "ours": "25.57", "difference": "0 %", "samples": "1", "why": ""}]},
    {"name": "fig02", "title": "Figure 2", "png": "fig02.png", "failure": "too slow", "rows": []}]})");
  const std::string page = page_of(folder, {"r"});
  EXPECT_THAT(page, HasSubstr("Figure 1: &lt;restitution&gt;"));
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,Zm9v"));
  EXPECT_THAT(page, HasSubstr("<td>25.58</td><td>25.57</td>"));
  EXPECT_THAT(page, HasSubstr("There is no fig02.png."));
  EXPECT_THAT(page, HasSubstr("Not made: too slow"));
}

}  // namespace
}  // namespace myowave::apps
