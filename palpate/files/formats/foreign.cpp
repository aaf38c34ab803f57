#include "palpate/files/formats/foreign.h"

#include "palpate/base/error.h"

namespace palpate {
namespace {

struct ForeignFile {
    std::string_view start, what, remedy;
};

constexpr ForeignFile foreign_files[] = {
    {"version https://git-lfs", "a Git LFS pointer, not the file itself,", "fetch it with git lfs pull"},
    {"<!DOCTYPE html", "a web page, not the file itself,", "download the file itself"},
    {"<!doctype html", "a web page, not the file itself,", "download the file itself"},
    {"<html", "a web page, not the file itself,", "download the file itself"},
    {"ISO-10303-21", "a STEP file, which has no triangles,", "export it as .stl"},
    {"BZh", "a file compressed by bzip2", "unpack it first"},
    {"\xfd"
     "7zXZ",
     "a file compressed by xz", "unpack it first"},
    {"\x28\xb5\x2f\xfd", "a file compressed by zstd", "unpack it first"},
    {"7z\xbc\xaf\x27\x1c", "a 7z archive", "unpack it first"},
    {"Rar!\x1a\x07", "a RAR archive", "unpack it first"}};

}  // namespace

void refuse_foreign(std::string_view bytes, const std::string& name) {
    for (const auto& [start, what, remedy] : foreign_files)
        if (bytes.starts_with(start)) throw Error(what, name, remedy);
}

}  // namespace palpate
