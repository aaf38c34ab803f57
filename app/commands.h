#pragma once

namespace CLI {
class App;
}

// The subcommands of `palpate`, one file each. Each adds itself to the command line and runs as its callback;
// failures are thrown as palpate::Error and printed by main.
void add_run(CLI::App& app);
void add_import(CLI::App& app);
void add_info(CLI::App& app);
void add_list(CLI::App& app);
void add_bench(CLI::App& app);
void add_doctor(CLI::App& app);
