// The `myowave` command: reads the command line, runs the subcommand, turns exceptions into exit statuses.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "apps/base/revision.hpp"
#include "apps/cli/commands.hpp"
#include "apps/input/did_you_mean.hpp"
#include "solver/base/error.hpp"

namespace {

using namespace myowave;

enum ExitStatus { done = 0, machine_failed = 1, wrong_input = 2, numerics_failed = 3, stopped = 75 };

void add_commands(CLI::App& app) {
  app.set_version_flag("--version", fmt::format("myowave {} ({})", apps::version(), apps::git_revision()));
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done, 1 the machine failed, 2 the input is wrong, 3 the numerics failed,\n"
      "75 stopped on request; resume with `myowave run --resume DIR`.\n"
      "Example: myowave run apps/scenes/quickstart.toml --set excitation.mu1=0.1 --until 50");
  // `--help` lists them in this order.
  apps::add_run(app);
  apps::add_check(app);
  apps::add_describe(app);
  apps::add_stability(app);
  apps::add_reproduce(app);
  apps::add_report(app);
  apps::add_sweep(app);
  apps::add_tradeoff(app);
  apps::add_info(app);
  apps::add_help(app);
}

// CLI11 would only report that a subcommand is missing.
// Errors: InputError.
void require_subcommand(const CLI::App& app, std::string_view word) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->get_name() == word) return;
    names.push_back(command->get_name());
  }
  const std::string meant = apps::did_you_mean(word, {names.begin(), names.end()});
  throw solver::InputError(
      fmt::format("myowave: there is no subcommand \"{}\"{}\nRun `myowave --help` for the list.", word,
                  apps::hint(meant)));
}

// Parses the command line, which runs the subcommand.
ExitStatus run(CLI::App& app, int argc, char** argv) {
  try {
    if (argc > 1 && argv[1][0] != '-') require_subcommand(app, argv[1]);
    app.parse(argc, argv);
    return done;
  } catch (const CLI::Success& asked) {  // --help, --version
    app.exit(asked);
    return done;
  } catch (const CLI::ParseError& error) {
    const auto given = app.get_subcommands();
    fmt::print(stderr, "myowave: {}\nRun `myowave{} --help` for its options.\n", error.what(),
               given.empty() ? "" : " " + given.front()->get_name());
    return wrong_input;
  } catch (const solver::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return wrong_input;
  } catch (const solver::NumericalFailure& error) {
    fmt::print(stderr, "myowave: the numerics failed: {}\n", error.what());
    return numerics_failed;
  } catch (const solver::Interrupted& interrupted) {
    fmt::print(stderr, "myowave: {}\n", interrupted.what());
    return stopped;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "myowave: out of memory\n");
  } catch (const std::exception& error) {
    fmt::print(stderr, "myowave: {}\n", error.what());
  }
  return machine_failed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Reaction-diffusion-mechanics of excitable tissue (Nash & Panfilov 2004)", "myowave"};
  add_commands(app);
  return run(app, argc, argv);
}
