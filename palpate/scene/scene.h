#pragma once
#include "palpate/body/collider.h"
#include "palpate/body/embedding.h"
#include "palpate/body/feel.h"
#include "palpate/body/material.h"
#include "palpate/body/pressure_map.h"
#include "palpate/body/simulation.h"
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/repair.h"
#include "palpate/scene/camera.h"
#include "palpate/scene/path.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace palpate {

// A scene consists of recipes: what to read, what to make of it, what happens to it. Plain data; build()
// (build.h) makes the bodies. docs/scene-format.md describes the file; each field below is a key of the same
// name.

/// The lines of a recipe and its keys in the file, for messages. They do not matter when recipes are
/// compared.
struct Lines {
    int table = 0;                    // 0: unknown
    std::map<std::string, int> keys;  // of the keys that are given, also as "pin.radius"; 0: by a change

    bool has(const std::string& key) const { return keys.contains(key); }
    /// The line of a key; that of the recipe if the key is not given.
    int of(const std::string& key) const {
        const auto found = keys.find(key);
        return found == keys.end() ? table : found->second;
    }
    /// The place of a key for messages: the file and the line; "--set" if it came by a change.
    std::string where(const std::string& key, const std::string& file) const;
    bool operator==(const Lines&) const { return true; }
};

/// A selection of nodes of a body at rest; several criteria may be given at once.
struct Choice {
    std::optional<float> below;  // the lowest part of the body's height along gravity: 0.15 is 15 %
    std::vector<int> nodes;      // by number
    std::optional<vec3> near;    // around a point, m ...
    float radius = 0;            // ... within this, m; 0 takes the nearest node alone
    std::vector<vec3> box;       // two opposite corners, m

    bool empty() const { return !below && nodes.empty() && !near && box.empty(); }
    bool operator==(const Choice&) const = default;
};

/// A part of a body that is harder or softer than the rest: selected nodes, or those with this label in a
/// label volume (a segmentation), and one of the last three. Where regions overlap, the last one wins.
struct Region {
    Choice choice;       // its fields are keys of the region itself
    std::string labels;  // a file of voxels, in the body's units (or mm), rotated and moved like the body
    std::optional<float> label;  // the label of the region
    float youngs_modulus = 0;    // Pa
    float stiffness = 0;         // N/m of each spring
    float factor = 0;            // its stiffness over the body's
    Lines lines;
    bool operator==(const Region&) const = default;
};

/// How a surface is coloured.
enum class Shade {
    colour,   // its colour, lit
    normals,  // its present normals: x, y and z as red, green and blue (2005, figure 6)
    pressure  // how hard tools press it: from pale to dark
};

inline std::span<const Named<Shade>> names(Shade) {
    static constexpr Named<Shade> all[] = {
        {Shade::colour, "colour"}, {Shade::normals, "normals"}, {Shade::pressure, "pressure"}};
    return all;
}

/// How a body is made: its source, its material, its look.
struct BodyRecipe {
    std::string name;
    std::string volume;   // a file of voxels, or a folder of slices; or
    std::string surface;  // a file of triangles; or
    std::vector<std::string>
        stand_ins;               // other files: if the surface is not found, the first of these that is
    std::optional<ivec3> dims;   // a plain box with this many nodes along each axis; or
    std::optional<ivec2> cloth;  // a rectangle of cloth
    bool sheet = false;          // the surface itself is cloth: a node at each vertex, a spring along each
                                 // edge
    std::optional<float> iso;    // the value of the isosurface of a volume; else one that its histogram
                                 // suggests
    std::optional<Units> units;  // of the file; else what it states, or mm (volumes) or m (surfaces)
    vec3 rotate = vec3(0);       // degrees about x, then y, then z
    float size = 0;              // m: after rotating, scales it so that its longest side is this; 0: no
                                 // scaling
    bool centre = false;         // then moves the centre of its bounding box to the origin
    vec3 move = vec3(0);         // m, after that
    bool largest = true;         // keeps only the largest connected part
    RepairSettings repair{};     // its weld, specks, solid and voxel are keys of the body; the others are
                                 // derived
    std::optional<int> smooth;   // passes of Taubin smoothing; 10 for a volume, 0 for a surface
    int faces = 0;               // decimates the surface to about this many; 0: no decimation
    int nodes = 20'000;          // of the lattice; or
    float spacing = 0;           // m
    std::optional<ivec3> cage;   // instead: a plain box with this many nodes around the surface; a final 1
                                 // makes a sheet
    Material material;           // its fields are keys of the body itself, and the key `tissue` gives those
                                 // that are missing (body/tissues.h); of cloth, density is in kg/m²
    std::optional<SpringKinds> springs;  // of cloth, or of the volume of 2012 with dims
    Choice pin;                          // nodes to pin
    float bending = 0;                   // N m, of a sheet (ClothSettings)
    std::vector<Region> regions;
    Mapping mapping = Mapping::automatic;
    vec3 colour = vec3(0.80f, 0.55f, 0.50f);  // linear red, green, blue from 0 to 1
    float shine = 0.4f;                       // of the specular reflection: 0 dull, 1 wet
    std::string colour_map;                   // a texture, multiplied with the colour, which is then white
                                              // unless given
    std::string normal_map;                   // a normal map in tangent space, y up, 0 to 255 for -1 to 1; or
    std::optional<ivec2> weave;               // that of a woven cloth with this many threads across u and v
                                              // (mesh/relief.h)
    Shade shade = Shade::colour;
    float pressure_scale = 10'000;  // Pa, of the darkest colour, where the pressure is shown
    Feel feel;                      // for tools of the kind dent
    Lines lines;

    bool has_normal_map() const { return !normal_map.empty() || weave; }
    bool is_textured() const { return !colour_map.empty() || has_normal_map(); }
    bool is_cloth() const { return cloth || sheet || (cage && cage->z == 1); }
    /// Whether nothing is said of how stiff a solid is. Then it is tissue, and build() finds a modulus at
    /// which it bears its own weight (own_weight.h): three hundredths of strain on Earth, as the scene has
    /// its down.
    bool bears_its_weight() const {
        return !is_cloth() && !is_flat() && !springs && material.youngs_modulus == 0 &&
               material.stiffness == 0;
    }
    /// Whether it is a solid of cells, and not of springs.
    bool is_of_tissue() const {
        return !is_cloth() && !is_flat() && !springs && (is_tissue(material) || bears_its_weight());
    }
    /// Whether it is a box that is one node thick, which has no cells.
    bool is_flat() const { return dims && std::min({dims->x, dims->y, dims->z}) < 2; }
    bool operator==(const BodyRecipe&) const = default;
};

/// A collider. If its shape is in a file, build() fills it in: a Polygon's triangles, or a DistanceField, of
/// which only the spacing is given here.
struct ColliderRecipe {
    Collider collider;
    std::string surface;         // a file of triangles ...
    std::optional<Units> units;  // ... in these units; else in what it states, or metres
    vec3 rotate = vec3(0);       // degrees about x, then y, then z
    vec3 move = vec3(0);         // m, after rotating
    Path path;                   // shift and rotation over time; empty: it stands still
    std::optional<vec3> about;   // the centre of the rotation; else the shape's own centre
    vec3 colour = vec3(0.5f);
    Lines lines;
};

/// Prescribed motion of some nodes.
struct MoveRecipe {
    std::string body;  // may be omitted if there is only one
    Choice nodes;
    Path path;                  // shift and rotation over time
    std::optional<vec3> about;  // the centre of the rotation; else that of the nodes at rest
    Lines lines;
    bool operator==(const MoveRecipe&) const = default;
};

enum class ToolKind {
    press,  // a round tip that pushes
    drag,   // a spring that pulls one node along
    dent,   // a haptic tip that feels surfaces and dents them in pictures; bodies do not react (2007)
    touch,  // a haptic tip that feels surfaces, and pushes the bodies that it feels
};

/// Whether a tool is a haptic hand.
inline bool feels(ToolKind kind) { return kind == ToolKind::dent || kind == ToolKind::touch; }
/// Whether a tool's tip presses bodies.
inline bool presses_bodies(ToolKind kind) { return kind == ToolKind::press || kind == ToolKind::touch; }

inline std::span<const Named<ToolKind>> names(ToolKind) {
    static constexpr Named<ToolKind> all[] = {{ToolKind::press, "press"},
                                              {ToolKind::drag, "drag"},
                                              {ToolKind::dent, "dent"},
                                              {ToolKind::touch, "touch"}};
    return all;
}

/// A tool that follows a path and acts on bodies; it is present from the path's first time to its last.
struct ToolRecipe {
    std::string name;
    ToolKind kind = ToolKind::press;
    std::string device =
        "script";  // for a dent or a touch: the name of a device that follows a path (touch/drivers.h)
    float radius = 0.01f;        // m; for a drag only the size of the drawing
    float stiffness = 400;       // N/m, see Press and NodePush; 50 for a drag
    Friction friction = {0, 0};  // of a press, see there,
    float damping = 0;           // N·s/m, and its damper
    Path path;                   // s, m; a file of rows or the rows themselves
    vec3 colour = vec3(0.25f, 0.45f, 0.75f);
    // ---- for a press, a dent or a touch ----
    /// If given, the path starts where the tip, moved from this point ...
    std::optional<vec3> from;
    /// ... in this direction, first touches a surface; the path's positions are relative to that place.
    vec3 along = vec3(0, -1, 0);
    float shaft = 0;  // m: the length of a rod behind the tip, against `along`, that is only drawn
    // ---- for a press or a touch ----
    std::optional<Pad> pad;  // a tactile sensor, centred on the tip
    // ---- for a drag ----
    std::string body;          // the body whose node it pulls; empty: the nearest
    std::optional<vec3> near;  // it grasps the node nearest to this point; else to the path's first position
    bool relative = false;     // the path's positions are relative to the node's place at that time
    Lines lines;
    bool operator==(const ToolRecipe&) const = default;
};

/// The camera. What is not given is chosen by run/framing.h.
struct CameraRecipe {
    std::optional<vec3> eye;  // m
    std::variant<std::monostate, vec3, std::string>
        look_at;                   // a point, m, or the name of a body or a surface
    std::optional<vec3> up;        // else against gravity
    float angle = Camera{}.angle;  // degrees
    bool orthographic = false;
    Lines lines;
};

/// The contents of a scene's file.
struct Scene {
    std::string name;              // of the file, without its extension
    std::string file;              // as it was given, for messages
    std::filesystem::path folder;  // the base of relative file names
    Simulation simulation;         // without what build() adds: colliders, contact and pull
    double duration = 5;           // s, the default length of a run
    Path wind;                     // its velocity over time, m/s; empty: none
    CameraRecipe camera;
    Light light;
    std::vector<BodyRecipe> bodies;
    std::vector<BodyRecipe>
        surfaces;  // static surfaces: of these recipes only the surface, its look and its feel are used
    std::vector<ColliderRecipe> colliders;
    std::vector<MoveRecipe> moves;
    std::vector<ToolRecipe> tools;
    std::vector<std::string> notes;  // warnings about the file, such as a number whose unit may be wrong
    /// The files that its paths were read from.
    std::vector<std::filesystem::path> path_files;
};

inline bool has_tool(const Scene& scene, ToolKind kind) {
    return std::ranges::any_of(scene.tools, [&](const ToolRecipe& tool) { return tool.kind == kind; });
}

/// The up direction: the camera's, else against gravity, else y. Unit.
vec3 sky(const Scene& scene);

/// A change from outside the file: `body.brain.nodes=5000`. If there are two colliders, `collider.3={ plane =
/// {} }` adds a third. A change that gives a body another source (volume, surface, dims, cloth) removes the
/// keys of the old one: its file, iso, units and maps.
using Change = std::string;

/// The text of a scene, which can be changed, read again and saved.
struct SceneText {
    std::string text;
    std::string name;              // of its file or of a shipped scene, for messages
    std::filesystem::path folder;  // the base of relative file names
};

/// Finds the text of a scene by the name of a shipped scene or the path of a TOML file; or makes one for a
/// mesh or a volume, which becomes a soft body of 0.2 m that is held at its bottom. Throws Error if there is
/// none, or if the extension is unknown.
SceneText find_scene(const std::string& file_or_name);

/// Its text with changes applied, for saving: TOML that reads as the same scene. Comments and the order of
/// keys are lost. Throws Error.
std::string changed(const SceneText& scene, std::span<const Change> changes);

/// Reads a scene that find_scene() finds. Changes are applied before it is checked. Throws an Error with the
/// file, the line and the most similar known key if something is invalid.
Scene read_scene(const std::string& file_or_name, std::span<const Change> changes = {});

/// The same from a text; `name` is for messages, and `folder` is the base of relative file names.
Scene parse_scene(const std::string& text, const std::string& name, const std::filesystem::path& folder,
                  std::span<const Change> changes = {});

inline Scene parse_scene(const SceneText& scene, std::span<const Change> changes = {}) {
    return parse_scene(scene.text, scene.name, scene.folder, changes);
}

/// A scene that comes with Palpate.
struct ShippedScene {
    std::string name;
    std::string text;
    std::string about;  // its first comment
};
const std::vector<ShippedScene>& shipped_scenes();

/// Finds a file or a folder of a scene: an absolute path as it is; else in the scene's folder, in the folder
/// of the environment variable PALPATE_DATA, or where Debian's mricron-data puts its templates. Throws Error.
std::filesystem::path find_data(const std::string& name, const std::filesystem::path& folder);
bool is_found(const std::string& name, const std::filesystem::path& folder);
/// The remedy if it is not found: a file beside the scene with a similar name, or where to put files.
std::string remedy_for_missing(const std::string& name, const std::filesystem::path& folder);

}  // namespace palpate
