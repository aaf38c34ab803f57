#pragma once
#include <cstdio>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace palpate {

/// The whole text of a file. Throws Error if it cannot be read, or is a pipe or a device.
std::string read_text(const std::filesystem::path& path);

/// A file that is being written, atomically: under a temporary name in the same folder (a rename across disks
/// would be a copy). This object removes it again unless finish() has given it its final name.
class Unfinished {
 public:
    explicit Unfinished(const std::filesystem::path& path);
    ~Unfinished();
    Unfinished(const Unfinished&) = delete;
    Unfinished& operator=(const Unfinished&) = delete;

    /// The name to write under.
    const std::filesystem::path& name() const { return name_; }
    /// Gives it its final name, replacing an older file. Throws Error.
    void finish();

 private:
    std::filesystem::path path_, name_;
    bool finished_ = false;
};

/// Removes every file that is still unfinished. For when the process is asked to stop: a signal handler may
/// call it.
void remove_unfinished() noexcept;

/// Writes a file whole or not at all: `write` fills a temporary file beside it, which takes the final name
/// only when everything has reached the disk. If `write` throws, or the disk is full, the temporary file is
/// removed, an older file under the final name stays as it was, and Error is thrown.
/// A link is followed; a pipe or a device is written to directly.
void write_file(const std::filesystem::path& path, const std::function<void(std::FILE*)>& write);

/// write_file for a text.
void write_text(const std::filesystem::path& path, std::string_view text);

/// Checks before long work that its result can be written: throws Error if the file's folder is missing or
/// not writable, if a folder has its name, or if its name does not end in `extension` (such as ".svg"). A
/// device or a pipe may have any name.
void check_output(const std::filesystem::path& path, std::string_view extension = {});

/// Throws Error if writing to `output` would replace one of the input files, also under another name of the
/// same file. A device or a pipe may be both.
void check_not_input(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs);

/// Throws Error if there is no such folder; an empty path is the current folder. `wanted_for`: what shall be
/// written there, for the message.
void check_folder(const std::filesystem::path& folder, std::string_view wanted_for);

/// Creates a folder and its missing parents. Throws Error if it cannot, or if no file can be written in it.
void make_folder(const std::filesystem::path& folder);

}  // namespace palpate
