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

/// A file on its way: filled under another name beside its own (a rename across disks would be a copy), and
/// gone again with this object unless finish() has given it its own name.
class Unfinished {
 public:
    explicit Unfinished(const std::filesystem::path& path);
    ~Unfinished();
    Unfinished(const Unfinished&) = delete;
    Unfinished& operator=(const Unfinished&) = delete;

    /// The name to write under.
    const std::filesystem::path& name() const { return name_; }
    /// Takes the place of an older file. Throws Error.
    void finish();

 private:
    std::filesystem::path path_, name_;
    bool finished_ = false;
};

/// Removes every file that is still unfinished. For the moment when the process is told to stop: a handler of
/// signals may call it.
void remove_unfinished() noexcept;

/// Writes a file whole or not at all: `write` fills a temporary file beside it, which takes the final name
/// only when everything has reached the disk. If `write` throws, or the disk is full, the temporary file is
/// removed, an older file under the final name stays as it was, and Error is thrown.
/// A link is followed; a pipe or a device is written to directly.
void write_file(const std::filesystem::path& path, const std::function<void(std::FILE*)>& write);

/// write_file for a text that is ready.
void write_text(const std::filesystem::path& path, std::string_view text);

/// Says before the work what could not be written after it: throws Error if the file's folder is missing or
/// closed to us, if a folder has its name, or if its name does not end in `ending` (".svg"), which is what it
/// will hold. A device or a pipe may have any name.
void check_output(const std::filesystem::path& path, std::string_view ending = {});

/// Throws Error if writing there would replace one of these files, which are read: also by another name of
/// the same file. A device or a pipe may be both.
void check_not_input(const std::filesystem::path& output, std::span<const std::filesystem::path> inputs);

/// Throws Error if there is no such folder; an empty path is the current one. `wanted_for`: what is to be in
/// it, for the message.
void check_folder(const std::filesystem::path& folder, std::string_view wanted_for);

/// Creates a folder and its parents where they are missing. Throws Error if it cannot, or if no file can be
/// written in it.
void make_folder(const std::filesystem::path& folder);

}  // namespace palpate
