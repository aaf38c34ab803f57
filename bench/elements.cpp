// The blocks of bench/tissue.h by CalculiX: its input, and what it finds.
#include "bench/tissue.h"
#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/base/pipe.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <sstream>

namespace palpate::studies {
namespace {

// A box of hexahedra of 20 nodes. Nodes stand at the corners and in the middle of the edges of elements: of a
// grid twice as fine those with at most one odd coordinate.
struct Hexahedra {
    dvec3 size;      // m
    ivec3 elements;  // along each axis

    ivec3 dims() const { return 2 * elements + 1; }
    int number(ivec3 at) const { return 1 + at.x + dims().x * (at.y + dims().y * at.z); }
    dvec3 place(ivec3 at) const { return size * dvec3(at) / dvec3(2 * elements); }

    template <class Visit>
    void for_each_node(Visit visit) const {
        for (int z = 0; z < dims().z; ++z)
            for (int y = 0; y < dims().y; ++y)
                for (int x = 0; x < dims().x; ++x)
                    if (x % 2 + y % 2 + z % 2 <= 1) visit(ivec3(x, y, z));
    }
    template <class Visit>
    void for_each_element(Visit visit) const {  // by the first of its corners
        for (int z = 0; z < elements.z; ++z)
            for (int y = 0; y < elements.y; ++y)
                for (int x = 0; x < elements.x; ++x) visit(2 * ivec3(x, y, z));
    }
};

// In the order of a C3D20: the corners below and above, the edges below, above and between.
constexpr ivec3 corners_and_edges[] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2},
                                       {2, 0, 2}, {2, 2, 2}, {0, 2, 2}, {1, 0, 0}, {2, 1, 0},
                                       {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2}, {1, 2, 2},
                                       {0, 1, 2}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}};

std::string mesh_of(const Hexahedra& box) {
    std::string text = "*NODE, NSET=ALL\n";
    box.for_each_node([&](ivec3 at) {
        const dvec3 p = box.place(at);
        text += fmt::format("{}, {:.9g}, {:.9g}, {:.9g}\n", box.number(at), p.x, p.y, p.z);
    });
    text += "*ELEMENT, TYPE=C3D20R, ELSET=BLOCK\n";
    int element = 0;
    box.for_each_element([&](ivec3 first) {
        text += std::to_string(++element);
        for (std::size_t k = 0; k < std::size(corners_and_edges); ++k)
            text += fmt::format(",{}{}", k == 10 ? "\n" : " ", box.number(first + corners_and_edges[k]));
        text += "\n";
    });
    return text;
}

std::string set_of(const char* name, const Hexahedra& box, const std::function<bool(ivec3)>& is_in) {
    std::string text = fmt::format("*NSET, NSET={}\n", name);
    box.for_each_node([&](ivec3 at) {
        if (is_in(at)) text += fmt::format("{},\n", box.number(at));
    });
    return text;
}

// U = C10 (I1 / J^(2/3) - 3) + (J - 1)² / D1, with the small-strain moduli of the block.
std::string material_of(const Block& block) {
    const Laws laws(block.youngs_modulus, block.poisson);
    return fmt::format(
        "*MATERIAL, NAME=TISSUE\n*HYPERELASTIC, NEO HOOKE\n{:.9g}, {:.9g}\n*DENSITY\n{}\n"
        "*SOLID SECTION, ELSET=BLOCK, MATERIAL=TISSUE\n",
        laws.shear / 2, 2 / laws.bulk, density);
}

constexpr const char* end_of_step = "*NODE PRINT, NSET=ALL, FREQUENCY=1000\nU\n*END STEP\n";

// A folder of its own, which goes with this object.
struct Scratch {
    std::filesystem::path path;
    Scratch() : path(std::filesystem::temp_directory_path() / "palpate-XXXXXX") {
        std::string name = path;
        if (!mkdtemp(name.data())) throw Error("no folder can be made in " + path.parent_path().string());
        path = name;
    }
    ~Scratch() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
};

// ccx writes more than it is asked for, wherever it is run.
struct RunIn {
    std::filesystem::path before = std::filesystem::current_path();
    explicit RunIn(const std::filesystem::path& folder) { std::filesystem::current_path(folder); }
    ~RunIn() {
        std::error_code ignored;
        std::filesystem::current_path(before, ignored);
    }
};

// All that CalculiX prints.
std::string solved(const std::string& input) {
    const Scratch scratch;
    write_text(scratch.path / "block.inp", input);
    const RunIn in(scratch.path);
    Pipe ccx({"ccx", "-i", "block"});
    ccx.finish();
    return read_text(scratch.path / "block.dat");
}

// What CalculiX prints under each heading in which these words stand, of which there are so many: rows of
// numbers.
using Rows = std::vector<std::vector<double>>;
std::vector<Rows> rows_under(const std::string& words, const std::string& text, std::size_t headings) {
    std::istringstream lines(text);
    std::vector<Rows> found;
    bool wanted = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.find("time") != line.npos) {
            wanted = line.find(words) != line.npos;
            if (wanted) found.emplace_back();
            continue;
        }
        std::istringstream numbers(line);
        std::vector<double> row(std::istream_iterator<double>(numbers), {});
        if (wanted && !row.empty()) found.back().push_back(std::move(row));
    }
    if (found.size() != headings || (headings > 0 && found.back().empty()))
        throw Error("CalculiX has not printed each " + words);
    return found;
}

// Where the nodes of a box are at the end of a step; by their numbers.
std::vector<dvec3> places_in(const Hexahedra& box, const Rows& displacements) {
    std::vector<dvec3> places(std::size_t(box.number(box.dims() - 1)) + 1);
    box.for_each_node([&](ivec3 at) { places[std::size_t(box.number(at))] = box.place(at); });
    for (const auto& row : displacements)
        places.at(std::size_t(row.at(0))) += dvec3(row.at(1), row.at(2), row.at(3));
    return places;
}

// The gradient of the shape function of a node at `q`, all coordinates from -1 to 1.
dvec3 shape_gradient(ivec3 node, dvec3 q) {
    const dvec3 n = dvec3(node - 1);
    const dvec3 one = 1.0 + n * q;
    dvec3 gradient;
    for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        if (n.x * n.y * n.z != 0)
            gradient[a] = n[a] * one[b] * one[c] * (2 * n[a] * q[a] + n[b] * q[b] + n[c] * q[c] - 1) / 8;
        else if (n[a] == 0)
            gradient[a] = -q[a] * one[b] * one[c] / 2;
        else
            gradient[a] = n[a] * (n[b] == 0 ? (1 - q[b] * q[b]) * one[c] : one[b] * (1 - q[c] * q[c])) / 4;
    }
    return gradient;
}

// Of what depends on the deformation gradient, by the 2 × 2 × 2 points at which a C3D20R knows it.
template <class Density>
double integral(const Hexahedra& box, const std::vector<dvec3>& places, Density density_of) {
    const double point = 1 / std::sqrt(3.0);
    const dvec3 edges = box.size / dvec3(box.elements);
    double sum = 0;
    box.for_each_element([&](ivec3 first) {
        for (int p = 0; p < 8; ++p) {
            const dvec3 at = point * dvec3(p & 1 ? 1 : -1, p & 2 ? 1 : -1, p & 4 ? 1 : -1);
            dmat3 gradient(0);
            for (ivec3 node : corners_and_edges)
                gradient += glm::outerProduct(places[std::size_t(box.number(first + node))],
                                              shape_gradient(node, at) * 2.0 / edges);
            sum += density_of(gradient) / 8;
        }
    });
    return sum * edges.x * edges.y * edges.z;
}

// Over that at rest.
double volume_ratio(const Hexahedra& box, const std::vector<dvec3>& places) {
    return integral(box, places, [](const dmat3& f) { return glm::determinant(f); }) /
           (box.size.x * box.size.y * box.size.z);
}

}  // namespace

// A quarter of it: the planes x and z through its middle are its planes of symmetry.
std::vector<PressedBlock> press_by_elements(const Block& block, Plate plate, std::span<const double> depths,
                                            int elements) {
    const Hexahedra quarter{block.size * dvec3(0.5, 1, 0.5), ivec3(elements / 2, elements, elements / 2)};
    const ivec3 last = quarter.dims() - 1;
    std::string input = mesh_of(quarter) + material_of(block) +
                        set_of("GROUND", quarter, [](ivec3 at) { return at.y == 0; }) +
                        set_of("TOP", quarter, [&](ivec3 at) { return at.y == last.y; }) +
                        set_of("RIGHT", quarter, [&](ivec3 at) { return at.x == last.x; }) +
                        set_of("FRONT", quarter, [&](ivec3 at) { return at.z == last.z; }) +
                        "*BOUNDARY\nRIGHT, 1\nFRONT, 3\nGROUND, 1, 3\nTOP, 1\nTOP, 3\n";
    for (double depth : depths) {
        input += "*STEP, NLGEOM, INC=1000\n*STATIC\n0.5, 1\n*BOUNDARY\n";
        quarter.for_each_node([&](ivec3 at) {
            const dvec3 place = quarter.place(at), to = pressed_to(block, plate, depth, place);
            if (at.y == last.y)
                input += fmt::format("{}, 2, 2, {:.9g}\n", quarter.number(at), to.y - place.y);
        });
        input += "*NODE PRINT, NSET=TOP, FREQUENCY=1000, TOTALS=ONLY\nRF\n" + std::string(end_of_step);
    }
    const std::string output = solved(input);
    const auto forces = rows_under("total force", output, depths.size()),
               displacements = rows_under("displacements", output, depths.size());
    const Laws laws(block.youngs_modulus, block.poisson);
    std::vector<PressedBlock> found;
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const std::vector<dvec3> places = places_in(quarter, displacements.at(i));
        found.push_back({depths[i], -4 * forces.at(i).at(0).at(1), volume_ratio(quarter, places),
                         4 * integral(quarter, places, [&](const dmat3& f) { return laws.calculix(f); }),
                         4 * integral(quarter, places, [&](const dmat3& f) { return laws.tissue(f); })});
    }
    return found;
}

// Half of it: the plane z through its middle is its plane of symmetry.
BentBeam bend_by_elements(const Block& of, int elements) {
    const int along = int(std::lround(of.size.x / of.size.y)) * elements;
    const Hexahedra half{of.size * dvec3(1, 1, 0.5), ivec3(along, elements, elements / 2)};
    const ivec3 last = half.dims() - 1;
    const std::string input =
        mesh_of(half) + material_of(of) + set_of("WALL", half, [](ivec3 at) { return at.x == 0; }) +
        set_of("FRONT", half, [&](ivec3 at) { return at.z == last.z; }) +
        fmt::format(
            "*BOUNDARY\nFRONT, 3\nWALL, 1, 3\n*STEP, NLGEOM, INC=1000\n*STATIC\n0.25, 1\n*DLOAD\n"
            "BLOCK, GRAV, {:.9g}, 0, -1, 0\n",
            of.gravity) +
        end_of_step;
    const std::vector<dvec3> places = places_in(half, rows_under("displacements", solved(input), 1).at(0));
    return {of.size.y / 2 - places[std::size_t(half.number({last.x, last.y / 2, last.z}))].y,
            volume_ratio(half, places)};
}

}  // namespace palpate::studies
