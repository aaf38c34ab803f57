#include "palpate/base/files.h"

#include "palpate/base/error.h"
#include "tests/refusal.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

namespace palpate {
namespace {

TEST(Files, WhatIsWrittenIsRead) {
    Scratch scratch;
    const std::string text("a\0b\n\xff", 5);
    write_text(scratch / "file", text);
    EXPECT_EQ(read_text(scratch / "file"), text);
    write_text(scratch / "file", "");
    EXPECT_EQ(read_text(scratch / "file"), "");
    EXPECT_EQ(scratch.entries(), 1u);
}

TEST(Files, AFailureLeavesTheOldFileAndNothingElse) {
    Scratch scratch;
    write_text(scratch / "file", "old");
    EXPECT_THROW(write_file(scratch / "file",
                            [](std::FILE* file) {
                                std::fputs("half", file);
                                throw Error("no more", "memory", "stop");
                            }),
                 Error);
    EXPECT_EQ(read_text(scratch / "file"), "old");
    EXPECT_EQ(scratch.entries(), 1u);
}

TEST(Files, AFullDiskIsAnErrorWithNothingLeft) {
    // /dev/full takes opening and buffering but no byte. Reached through a link with the temporary file's
    // name.
    Scratch scratch;
    const auto file = scratch / "file";
    std::filesystem::create_symlink("/dev/full", file.string() + ".part" + std::to_string(getpid()));
    expect_refused("make room", [&] { write_text(file, std::string(1 << 20, 'x')); });
    EXPECT_EQ(scratch.entries(), 0u);
}

TEST(Files, WhatIsUnfinishedCanBeRemovedAtOnce) {
    Scratch scratch;
    {
        Unfinished first(scratch / "first"), second(scratch / "second");
        write_text(first.name(), "half");
        write_text(second.name(), "whole");
        second.finish();
        remove_unfinished();
        EXPECT_FALSE(std::filesystem::exists(first.name()));
        EXPECT_THROW(first.finish(), Error);
    }
    EXPECT_EQ(read_text(scratch / "second"), "whole");
    for (int i = 0; i < 1000; ++i) Unfinished(scratch / "none");  // their places are given back
    Unfinished late(scratch / "late");
    write_text(late.name(), "half");
    remove_unfinished();
    EXPECT_EQ(scratch.entries(), 1u);
}

TEST(Files, LinksAndDevicesStayWhatTheyAre) {
    Scratch scratch;
    write_text(scratch / "real", "old");
    std::filesystem::create_symlink(scratch / "real", scratch / "link");
    write_text(scratch / "link", "new");
    EXPECT_TRUE(std::filesystem::is_symlink(scratch / "link"));
    EXPECT_EQ(read_text(scratch / "real"), "new");
    std::filesystem::create_symlink("/dev/null", scratch / "nothing");
    write_text(scratch / "nothing", "x");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    std::filesystem::create_symlink(scratch / "gone", scratch / "dangling");
    EXPECT_THROW(write_text(scratch / "dangling", "x"), Error);
    EXPECT_EQ(scratch.entries(), 4u);
}

TEST(Files, APipeIsRefusedAndNotWaitedFor) {
    Scratch scratch;
    ASSERT_EQ(mkfifo((scratch / "pipe").c_str(), 0600), 0);
    expect_refused("a pipe or a device where a file was expected", [&] { read_text(scratch / "pipe"); });
}

TEST(Files, MissingPlacesAreNamed) {
    Scratch scratch;
    expect_refused("such", [&] { read_text(scratch / "no" / "such"); });
    expect_refused("such", [&] { write_text(scratch / "no" / "such", "x"); });
    EXPECT_THROW(read_text(scratch / "."), Error);
    write_text(scratch / "file", "");
    EXPECT_THROW(make_folder(scratch / "file" / "folder"), Error);
    EXPECT_NO_THROW(make_folder(scratch / "a" / "b"));
    EXPECT_NO_THROW(make_folder(scratch / "a" / "b"));
}

std::string refusal(const std::filesystem::path& path, const char* extension) {
    return palpate::refusal([&] { check_output(path, extension); });
}

TEST(Files, OutputsAreCheckedBeforeTheWork) {
    Scratch scratch;
    EXPECT_EQ(refusal(scratch / "a.svg", ".svg"), "");
    EXPECT_EQ(refusal(scratch / "A.SVG", ".svg"), "");
    EXPECT_NE(refusal(scratch / "a", ".svg").find("a.svg"), std::string::npos);
    EXPECT_EQ(refusal(scratch / "a.b", ""), "");
    EXPECT_EQ(refusal("", ".svg"), "");  // nothing is asked for
    EXPECT_NE(refusal(scratch / "a.png", ".svg").find("a.svg"), std::string::npos);
    EXPECT_NE(refusal(scratch / "no" / "a.svg", ".svg").find("no folder"), std::string::npos);
    EXPECT_NE(refusal(scratch / ".", ".svg").find("a folder"), std::string::npos);
    write_text(scratch / "old.svg", "old");
    EXPECT_EQ(refusal(scratch / "old.svg", ".svg"), "");
    EXPECT_EQ(read_text(scratch / "old.svg"), "old");
    std::filesystem::create_symlink("/dev/null", scratch / "device.x");
    EXPECT_EQ(refusal(scratch / "device.x", ".svg"), "");
    std::filesystem::create_symlink(scratch / "gone", scratch / "link.svg");
    EXPECT_NE(refusal(scratch / "link.svg", ".svg").find("nowhere"), std::string::npos);
    if (std::filesystem::is_directory("/proc"))  // where nobody may write, not even root
        EXPECT_NE(refusal("/proc/a.svg", ".svg").find("cannot write"), std::string::npos);
    EXPECT_EQ(scratch.entries(), 3u);
}

TEST(Files, AnInputIsKnownByAnyOfItsNames) {
    Scratch scratch;
    write_text(scratch / "in", "text");
    write_text(scratch / "same", "text");
    std::filesystem::create_symlink(scratch / "in", scratch / "link");
    std::filesystem::create_hard_link(scratch / "in", scratch / "hard");
    const std::vector<std::filesystem::path> inputs = {scratch / "gone", scratch / "." / "in", "/dev/null"};
    for (const char* name : {"in", "link", "hard"})
        EXPECT_THROW(check_not_input(scratch / name, inputs), Error) << name;
    for (const char* name : {"same", "gone", "new"})
        EXPECT_NO_THROW(check_not_input(scratch / name, inputs)) << name;
    EXPECT_NO_THROW(check_not_input("/dev/null", inputs));
    EXPECT_NO_THROW(check_not_input("", inputs));
}

TEST(Error, IsAlwaysOneLine) {
    const Error error("a\nb", "c\rd", "e\n");
    EXPECT_STREQ(error.what(), "a b in c d; e ");
}

}  // namespace
}  // namespace palpate
