#include "app/commands.h"
#include "palpate/base/files.h"
#include "palpate/base/halt.h"
#include "palpate/touch/emergency.h"

#include <CLI/CLI.hpp>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

namespace {

constexpr int failed = 1, wrong_usage = 2;

int complain(const char* what) {
    std::fprintf(stderr, "palpate: error: %s\n", what);
    return failed;
}

// However it ends, the command leaves no half of a file behind.
void tidy(palpate::Halt halt) noexcept {
    if (halt == palpate::Halt::ended) palpate::remove_unfinished();
}

}  // namespace

int main(int argc, char** argv) {
    std::signal(SIGINT, SIG_DFL);  // ignored where a shell started this in the background, but not for it
    palpate::let_go_at_halt();
    palpate::on_halt(tidy);
    CLI::App app("Deforms detailed surfaces in real time and lets people feel them.", "palpate");
    app.set_version_flag("--version", "palpate " PALPATE_VERSION);
    app.require_subcommand(1);
    add_run(app);
    add_import(app);
    add_info(app);
    add_list(app);
    add_bench(app);
    add_doctor(app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        app.exit(error);
        return wrong_usage;
    } catch (const std::bad_alloc&) {
        return complain("not enough memory in this machine; use fewer nodes or faces, or a smaller file");
    } catch (const std::exception& error) {
        return complain(error.what());
    }
    // Also what is still on its way to a full disk was asked for.
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
        return complain("cannot write the output; make room on the disk");
    return 0;
}
