// The subcommands of `myowave`, one source file a group. Each function adds its options to the command line;
// parsing then runs the subcommand that was given. Errors leave as exceptions, which main.cpp turns into exit
// statuses.
#pragma once

namespace CLI {
class App;
}

namespace myowave::apps {

void add_run(CLI::App&);
void add_check(CLI::App&);
void add_describe(CLI::App&);
void add_stability(CLI::App&);
void add_reproduce(CLI::App&);
void add_report(CLI::App&);
void add_sweep(CLI::App&);
void add_tradeoff(CLI::App&);
void add_info(CLI::App&);
void add_help(CLI::App&);

}  // namespace myowave::apps
