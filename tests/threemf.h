#pragma once
// 3MF files for tests.
#include "palpate/mesh/mesh.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zip.h>

#include <map>
#include <string>

namespace palpate {

/// An archive of files by name.
inline std::string zipped(const std::map<std::string, std::string>& files) {
    zip_source_t* to = zip_source_buffer_create(nullptr, 0, 0, nullptr);
    zip_source_keep(to);  // zip_close would let go of it
    zip_t* archive = zip_open_from_source(to, ZIP_TRUNCATE, nullptr);
    for (const auto& [name, text] : files)
        zip_file_add(archive, name.c_str(), zip_source_buffer(archive, text.data(), text.size(), 0),
                     ZIP_FL_ENC_UTF_8);
    EXPECT_EQ(zip_close(archive), 0);
    zip_stat_t about;
    EXPECT_EQ(zip_source_stat(to, &about), 0);
    std::string bytes(about.size, '\0');
    EXPECT_EQ(zip_source_open(to), 0);
    EXPECT_EQ(zip_source_read(to, bytes.data(), bytes.size()), zip_int64_t(bytes.size()));
    zip_source_close(to);
    zip_source_free(to);
    return bytes;
}

inline std::string mesh_of_3mf(const Mesh& mesh) {
    std::string text = "<mesh><vertices>";
    for (vec3 p : mesh.positions) text += fmt::format("<vertex x='{}' y='{}' z='{}'/>", p.x, p.y, p.z);
    text += "</vertices><triangles>";
    for (uvec3 t : mesh.triangles) text += fmt::format("<triangle v1='{}' v2='{}' v3='{}'/>", t.x, t.y, t.z);
    return text + "</triangles></mesh>";
}

/// The text of a model.
inline std::string model(const std::string& resources, const std::string& build,
                         const std::string& attributes = "") {
    return fmt::format(
        "<?xml version='1.0' encoding='UTF-8'?>\n<model {} "
        "xmlns='http://schemas.microsoft.com/3dmanufacturing/core/"
        "2015/02' xmlns:p='http://schemas.microsoft.com/3dmanufacturing/production/2015/06' "
        "xmlns:b='http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02'><resources>{}</resources>"
        "<build>{}</build></model>",
        attributes, resources, build);
}

}  // namespace palpate
