#include "palpate/base/files.h"

#include "palpate/base/error.h"

#include <unistd.h>

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

// A file that is removed again unless it is renamed first.
struct Temporary {
    std::filesystem::path path;
    bool keep = false;
    ~Temporary() {
        std::error_code ignored;
        if (!keep) std::filesystem::remove(path, ignored);
    }
};

}  // namespace

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
    Temporary temporary{temporary_beside(path)};
    std::unique_ptr<std::FILE, Close> file(std::fopen(temporary.path.c_str(), "wb"));
    if (!file) fail("cannot write", path, "check that the folder exists and may be written to");
    write(file.get());
    if (!flushed(file.get())) fail("cannot write", path, "make room on the disk");
    file.reset();
    if (std::rename(temporary.path.c_str(), path.c_str()) != 0)
        fail("cannot write", path, "check that no folder has this name");
    temporary.keep = true;
}

std::filesystem::path temporary_beside(const std::filesystem::path& path) {
    return path.string() + ".part" + std::to_string(getpid());
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
