#include "palpate/base/files.h"

#include "palpate/base/error.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <memory>
#include <thread>

namespace palpate {
namespace {

[[noreturn]] void fail(std::string_view what, const std::filesystem::path& path, std::string_view remedy) {
    throw Error(std::string(what) + " (" + std::strerror(errno) + ")", path.string(), remedy);
}

// Whether it is a pipe or a device, which is written to and never replaced.
bool is_special(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored) &&
           !std::filesystem::is_directory(path, ignored);
}

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

// The names of unfinished files, at fixed places, so that a signal handler may read them. A file that finds
// no free place is left behind if a signal ends the process.
std::array<std::atomic<const char*>, 64> unfinished{};
std::atomic<int> removing = 0;  // how many handlers may be reading one of them

void note(const char* name) {
    for (auto& place : unfinished)
        if (const char* nothing = nullptr; place.compare_exchange_strong(nothing, name)) return;
}

// When this returns, no handler reads the name any more.
void forget(const char* name) {
    for (auto& place : unfinished)
        if (const char* noted = name; place.compare_exchange_strong(noted, nullptr)) break;
    while (removing > 0) std::this_thread::yield();
}

}  // namespace

Unfinished::Unfinished(const std::filesystem::path& path)
    : path_(path), name_(path.string() + ".part" + std::to_string(getpid())) {
    note(name_.c_str());
}

Unfinished::~Unfinished() {
    forget(name_.c_str());
    std::error_code ignored;
    if (!finished_) std::filesystem::remove(name_, ignored);
}

void Unfinished::finish() {
    if (std::rename(name_.c_str(), path_.c_str()) != 0)
        fail("cannot write", path_, "check that no folder has this name");
    finished_ = true;
}

void remove_unfinished() noexcept {
    ++removing;
    for (auto& place : unfinished)
        if (const char* name = place.exchange(nullptr)) unlink(name);
    --removing;
}

std::string read_text(const std::filesystem::path& path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error))
        throw Error("a folder where a file was expected", path.string(), "name a file");
    if (is_special(path))  // opening a pipe would wait for its writer
        throw Error("a pipe or a device where a file was expected", path.string(), "save it as a file first");
    std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
    if (!file) fail("cannot open", path, "check the name and that it may be read");
    std::string text;
    char block[1 << 16];
    while (std::size_t n = std::fread(block, 1, sizeof block, file.get())) text.append(block, n);
    if (std::ferror(file.get())) fail("cannot read", path, "check the disk");
    return text;
}

namespace {

// True if everything written has reached the disk; a device or a pipe has no disk to wait for.
bool flushed(std::FILE* file) {
    return !std::ferror(file) && std::fflush(file) == 0 && (fsync(fileno(file)) == 0 || errno == EINVAL);
}

// The target of a link, or the name itself: a link stays a link, and its target is written.
std::filesystem::path destination(const std::filesystem::path& name) {
    std::error_code error, ignored;
    if (!std::filesystem::is_symlink(name, ignored)) return name;
    const std::filesystem::path path = std::filesystem::canonical(name, error);
    if (error) throw Error("a link that leads nowhere", name.string(), "remove it, or name another file");
    return path;
}

}  // namespace

void write_file(const std::filesystem::path& name, const std::function<void(std::FILE*)>& write) {
    const std::filesystem::path path = destination(name);
    if (is_special(path)) {
        std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "wb"));
        if (!file) fail("cannot write", path, "check that it may be written to");
        write(file.get());
        if (!flushed(file.get())) fail("cannot write", path, "make room on the disk");
        return;
    }
    Unfinished whole(path);
    std::unique_ptr<std::FILE, Close> file(std::fopen(whole.name().c_str(), "wb"));
    if (!file) fail("cannot write", path, "check that the folder exists and may be written to");
    write(file.get());
    if (!flushed(file.get())) fail("cannot write", path, "make room on the disk");
    file.reset();
    whole.finish();
}

void write_text(const std::filesystem::path& path, std::string_view text) {
    write_file(path, [&](std::FILE* file) { std::fwrite(text.data(), 1, text.size(), file); });
}

namespace {

// Creates a file and removes it at once: there is no other way to tell whether one can be written there.
bool can_begin(const std::filesystem::path& path) {
    const Unfinished trial(path);
    return std::unique_ptr<std::FILE, Close>(std::fopen(trial.name().c_str(), "wb")) != nullptr;
}

}  // namespace

void check_output(const std::filesystem::path& name, std::string_view extension) {
    if (name.empty()) return;
    std::error_code error;
    if (std::filesystem::is_directory(name, error))
        throw Error("a folder where a file is to be written", name.string(), "name a file");
    const std::filesystem::path path = destination(name);
    if (is_special(path)) return;
    const std::string has = name.extension().string();
    auto alike = [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); };
    if (!extension.empty() && !std::ranges::equal(has, extension, alike))
        throw Error(has.empty() ? "no extension to choose a format by" : "cannot write \"" + has + "\"",
                    name.string(),
                    "name it " + std::filesystem::path(name).replace_extension(extension).string() +
                        ", which is its format");
    check_folder(path.parent_path(), path.filename().string());
    if (!can_begin(path))
        fail("cannot write", path, "check that its folder may be written to, or name another");
}

void check_not_input(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(output, ignored)) return;
    for (const std::filesystem::path& input : inputs)
        if (std::filesystem::equivalent(output, input, ignored))
            throw Error("an input of the run would be replaced", output.string(), "name another file");
}

void check_folder(const std::filesystem::path& folder, std::string_view wanted_for) {
    std::error_code error;
    if (folder.empty() || std::filesystem::is_directory(folder, error)) return;
    throw Error(std::string("no folder for ") + std::string(wanted_for), folder.string(),
                "make it first, or name one that is there");
}

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder))
        throw Error("cannot create the folder (" + error.message() + ")", folder.string(),
                    "check that its parent may be written to and that no file has this name");
    if (!can_begin(folder / "trial"))
        fail("cannot write into the folder", folder, "check that it may be written to, or name another");
}

}  // namespace palpate
