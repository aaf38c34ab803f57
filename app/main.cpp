#include "app/commands.h"
#include "palpate/base/files.h"
#include "palpate/base/halt.h"
#include "palpate/base/nearest.h"
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

// However it ends, the command leaves no half-written file behind.
void tidy(palpate::Halt halt) noexcept {
    if (halt == palpate::Halt::ended) palpate::remove_unfinished();
}

// An empty value is usually an unset shell variable, and would count as an option that was not given.
void refuse_empty_values(CLI::App& app) {
    for (CLI::App* command : app.get_subcommands({}))
        for (CLI::Option* option : command->get_options())
            option->check(CLI::Validator(
                [](const std::string& value) {
                    return value.empty() ? "the value is empty; give one, or leave the option out"
                                         : std::string();
                },
                ""));
}

// A remedy for words that the command line does not know; empty if there is none.
std::string remedy_for_unknown(const CLI::App& app) {
    const CLI::App* command = &app;
    while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
    std::vector<std::string> known;
    std::string list;
    for (const CLI::App* one : command->get_subcommands([](const CLI::App*) { return true; })) {
        known.push_back(one->get_name());
        list += (list.empty() ? "" : ", ") + one->get_name();
    }
    for (const CLI::Option* option : command->get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    const std::vector<std::string> words = app.remaining(true);
    for (const std::string& word : words)
        if (const std::string meant = palpate::nearest(word.substr(0, word.find('=')), known); !meant.empty())
            return word + ": did you mean " + meant + "?\n";
    if (words.empty() || list.empty()) return {};
    return words.front() + " is not one of " + list + "\n";
}

std::string usage_message(const CLI::App* app, const CLI::Error& error) {
    return remedy_for_unknown(*app) + CLI::FailureMessage::simple(app, error);
}

}  // namespace

int main(int argc, char** argv) {
    std::signal(SIGINT, SIG_DFL);  // a shell starts background jobs with it ignored
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
    refuse_empty_values(app);
    app.failure_message(usage_message);
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
    // That the disk is full may show only when buffers are flushed.
    if (std::fflush(stdout) != 0 || std::ferror(stdout))
        return complain("cannot write the output; make room on the disk");
    return 0;
}
