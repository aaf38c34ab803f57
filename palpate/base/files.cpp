#include "palpate/base/files.h"

#include "palpate/base/error.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <memory>

namespace palpate {
namespace {

[[noreturn]] void fail(std::string_view what, const std::filesystem::path& path, std::string_view remedy) {
    throw Error(std::string(what) + " (" + std::strerror(errno) + ")", path.string(), remedy);
}

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

// The names of unfinished files, as a handler of signals may read them: at places that do not move. One that
// finds no place is only removed less surely.
std::array<std::atomic<const char*>, 64> unfinished{};

void note(const char* name) {
    for (auto& place : unfinished)
        if (const char* nothing = nullptr; place.compare_exchange_strong(nothing, name)) return;
}

void forget(const char* name) {
    for (auto& place : unfinished)
        if (const char* noted = name; place.compare_exchange_strong(noted, nullptr)) return;
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
    for (auto& place : unfinished)
        if (const char* name = place.exchange(nullptr)) unlink(name);
}

std::string read_text(const std::filesystem::path& path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error))
        throw Error("a folder where a file was expected", path.string(), "name a file");
    std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
    if (!file) fail("cannot open", path, "check the name and that it may be read");
    std::string text;
    char block[1 << 16];
    while (std::size_t n = std::fread(block, 1, sizeof block, file.get())) text.append(block, n);
    if (std::ferror(file.get())) fail("cannot read", path, "check the disk");
    return text;
}

namespace {

// True if everything written has left for the disk; a device or a pipe has none to wait for.
bool flushed(std::FILE* file) {
    return !std::ferror(file) && std::fflush(file) == 0 && (fsync(fileno(file)) == 0 || errno == EINVAL);
}

}  // namespace

void write_file(const std::filesystem::path& name, const std::function<void(std::FILE*)>& write) {
    std::filesystem::path path = name;
    std::error_code error, ignored;
    // A link stays a link: what it leads to is written.
    if (std::filesystem::is_symlink(name, ignored)) path = std::filesystem::canonical(name, error);
    if (error) throw Error("a link that leads nowhere", name.string(), "remove it, or name another file");
    const bool special = std::filesystem::exists(path, ignored) &&
                         !std::filesystem::is_regular_file(path, error) &&
                         !std::filesystem::is_directory(path, ignored);
    if (special) {  // a pipe or a device is written to, never replaced
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

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder))
        throw Error("cannot create the folder (" + error.message() + ")", folder.string(),
                    "check that its parent may be written to and that no file has this name");
}

}  // namespace palpate
