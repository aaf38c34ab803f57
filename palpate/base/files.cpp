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

void write_file(const std::filesystem::path& path, const std::function<void(std::FILE*)>& write) {
    // Beside the final name, because a rename across file systems would be a copy.
    Temporary temporary{path.string() + ".part" + std::to_string(getpid())};
    std::unique_ptr<std::FILE, Close> file(std::fopen(temporary.path.c_str(), "wb"));
    if (!file) fail("cannot write", path, "check that the folder exists and may be written to");
    write(file.get());
    bool written = !std::ferror(file.get()) && std::fflush(file.get()) == 0 && fsync(fileno(file.get())) == 0;
    if (!written) fail("cannot write", path, "make room on the disk");
    file.reset();
    if (std::rename(temporary.path.c_str(), path.c_str()) != 0)
        fail("cannot write", path, "check that no folder has this name");
    temporary.keep = true;
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
