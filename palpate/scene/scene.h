#pragma once
#include "palpate/body/collider.h"
#include "palpate/body/embedding.h"
#include "palpate/body/feel.h"
#include "palpate/body/material.h"
#include "palpate/body/simulation.h"
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/repair.h"
#include "palpate/scene/camera.h"
#include "palpate/scene/path.h"

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace palpate {

// A scene is recipes: what to read, what to make of it, what happens to it. Plain data; build() (build.h)
// makes the bodies. docs/scene-format.md describes the file; each field below is a key of the same name.

/// Where in the file a recipe and its keys came from, for messages. Recipes that differ only in that are
/// equal.
struct Lines {
    int table = 0;                    // 0: nobody knows
    std::map<std::string, int> keys;  // of those that are given, also as "pin.radius"; 0: by a change

    bool has(const std::string& key) const { return keys.contains(key); }
    /// The line of a key; of the recipe, if it is not given.
    int of(const std::string& key) const {
        const auto found = keys.find(key);
        return found == keys.end() ? table : found->second;
    }
    /// Where the scene of that file says it, for messages: the file and the line; "--set" where a change did.
    std::string where(const std::string& key, const std::string& file) const;
    bool operator==(const Lines&) const { return true; }
};

/// Which nodes of a body, at rest; several ways may be given at once.
struct Choice {
    std::optional<float> below;  // the lowest part of the body's height along gravity: 0.15 is 15 %
    std::vector<int> nodes;      // by number
    std::optional<vec3> near;    // around a point, m ...
    float radius = 0;            // ... within this, m; 0 takes the nearest node alone
    std::vector<vec3> box;       // two opposite corners, m

    bool empty() const { return !below && nodes.empty() && !near && box.empty(); }
    bool operator==(const Choice&) const = default;
};

/// A part of a body that is harder or softer than the rest: nodes of a choice, or those that a label volume
/// gives this label, and one of the last three. Where regions overlap, the last counts.
struct Region {
    Choice choice;  // its fields are keys of the region itself
    std::string
        labels;  // a file of voxels (mm unless the body says otherwise), turned and moved as the body is
    std::optional<float> label;  // the value of those that belong to the region
    float youngs_modulus = 0;    // Pa
    float stiffness = 0;         // N/m of each spring
    float factor = 0;            // times as stiff as the body
    Lines lines;
    bool operator==(const Region&) const = default;
};

/// What is seen of a surface.
enum class Shade {
    colour,   // in the light
    normals,  // its normals as they are at the moment: x, y and z as red, green and blue (2005, figure 6)
};

inline std::span<const Named<Shade>> names(Shade) {
    static constexpr Named<Shade> all[] = {{Shade::colour, "colour"}, {Shade::normals, "normals"}};
    return all;
}

/// How a body comes about: what it is made from, of what stuff it is, how it looks.
struct BodyRecipe {
    std::string name;
    std::string volume;   // a file of voxels, or a folder of slices; or
    std::string surface;  // a file of triangles; or
    std::vector<std::string>
        stand_ins;               // other files, the first of which that is found is taken where that is not
    std::optional<ivec3> dims;   // a plain box of so many nodes along each axis; or
    std::optional<ivec2> cloth;  // a rectangle of cloth
    bool sheet = false;          // the surface itself is cloth: a node a vertex, a spring an edge
    std::optional<float> iso;    // the value at the surface of a volume; else the one its values suggest
    std::optional<Units> units;  // of the file; else what it states, or mm (volumes), m (surfaces)
    vec3 rotate = vec3(0);       // degrees about x, then y, then z
    float size = 0;              // m: after turning, scale it so that its longest side is this; 0 leaves it
    bool centre = false;         // then bring the middle of its box to the origin
    vec3 move = vec3(0);         // m, after that
    bool largest = true;         // keep only the largest connected part
    RepairSettings repair{};     // its weld, specks, solid and voxel are keys of the body; the rest follows
    std::optional<int> smooth;   // passes of smoothing; 10 for a volume, 0 for a surface
    int faces = 0;               // simplify the surface to about this many; 0 leaves it
    int nodes = 20'000;          // of the lattice; or
    float spacing = 0;           // m
    std::optional<ivec3>
        cage;           // instead: a plain box of so many nodes around the surface; a last 1 is a sheet
    Material material;  // its fields are keys of the body itself; of cloth, density is in kg/m²
    std::optional<SpringKinds> springs;  // of cloth, or of the volume of 2012 with dims
    float bending = 0;                   // N m, of a sheet (ClothSettings)
    Choice pin;                          // nodes to hold fast
    std::vector<Region> regions;
    Mapping mapping = Mapping::automatic;
    vec3 colour = vec3(0.80f, 0.55f, 0.50f);  // linear red, green, blue from 0 to 1
    float shine = 0.4f;                       // 0 dull, 1 wet
    std::string colour_map;                   // a picture, times the colour, which is then white unless given
    std::string normal_map;      // a picture of normals in the tangent frame, y up, 0 to 255 as -1 to 1; or
    std::optional<ivec2> weave;  // that of a cloth of so many threads across u and v (mesh/relief.h)
    Shade shade = Shade::colour;
    Feel feel;  // under a tool that is felt
    Lines lines;

    bool has_normal_map() const { return !normal_map.empty() || weave; }
    bool is_textured() const { return !colour_map.empty() || has_normal_map(); }
    bool is_cloth() const { return cloth || sheet || (cage && cage->z == 1); }
    bool operator==(const BodyRecipe&) const = default;
};

/// A collider. Where its shape lies in a file, build() fills it in: a Polygon's triangles, or a DistanceField
/// of which only the spacing is given here.
struct ColliderRecipe {
    Collider collider;
    std::string surface;         // a file of triangles ...
    std::optional<Units> units;  // ... in these; else in what it states, or metres
    vec3 rotate = vec3(0);       // degrees about x, then y, then z
    vec3 move = vec3(0);         // m, after turning
    Path path;                   // shift and rotation over time; empty: it stands still
    std::optional<vec3> about;  // the point that the rotation leaves where it is; else the shape's own middle
    vec3 colour = vec3(0.5f);
    Lines lines;
};

/// Prescribed motion of some nodes.
struct MoveRecipe {
    std::string body;  // may be left out where there is only one
    Choice nodes;
    Path path;  // shift and rotation over time
    std::optional<vec3>
        about;  // the point that the rotation leaves where it is; else the nodes' middle at rest
    Lines lines;
    bool operator==(const MoveRecipe&) const = default;
};

enum class ToolKind {
    press,  // a round tip that pushes
    drag,   // a spring that pulls one node along
    dent,   // a hand's tip that feels surfaces and dents their pictures; bodies do not feel it (2007)
};

inline std::span<const Named<ToolKind>> names(ToolKind) {
    static constexpr Named<ToolKind> all[] = {
        {ToolKind::press, "press"}, {ToolKind::drag, "drag"}, {ToolKind::dent, "dent"}};
    return all;
}

/// What follows a path and acts on bodies; it is there from the path's first time to its last.
struct ToolRecipe {
    std::string name;
    ToolKind kind = ToolKind::press;
    std::string device = "script";  // of a dent: one that follows a path, by its name (touch/drivers.h)
    float radius = 0.01f;           // m; of a drag: how large it is drawn
    float stiffness = 400;          // N/m, see Press and NodePush; 50 for a drag
    Path path;                      // s, m; a file of rows or the rows themselves
    vec3 colour = vec3(0.25f, 0.45f, 0.75f);
    // ---- of a press, and of a dent ----
    /// If given, the path starts where the tip, moved from this point ...
    std::optional<vec3> from;
    /// ... in this direction, first touches a surface; the path's positions are counted from there.
    vec3 along = vec3(0, -1, 0);
    float shaft = 0;  // m: a rod behind the tip, against `along`, that is drawn only
    // ---- of a drag ----
    std::string body;          // whose node it pulls; empty: the nearest body's
    std::optional<vec3> near;  // it takes the node nearest to this point; else to the path's first position
    bool relative = false;     // the path's positions are counted from where that node is then
    Lines lines;
    bool operator==(const ToolRecipe&) const = default;
};

/// From where it is looked at. What is not given is found when there is something to see: run/framing.h.
struct CameraRecipe {
    std::optional<vec3> eye;  // m
    std::variant<std::monostate, vec3, std::string>
        look_at;                   // a point, m, or the name of a body or a surface
    std::optional<vec3> up;        // else against gravity
    float angle = Camera{}.angle;  // degrees
    bool orthographic = false;
    Lines lines;
};

/// All that a scene's file says.
struct Scene {
    std::string name;              // of the file, without its ending
    std::string file;              // as it was named, for messages
    std::filesystem::path folder;  // that files are named from
    Simulation simulation;         // without what build() adds: colliders, contact and pull
    double duration = 5;           // s, of a run that is not told otherwise
    Path wind;                     // its velocity over time, m/s; empty: none
    CameraRecipe camera;
    Light light;
    std::vector<BodyRecipe> bodies;
    std::vector<BodyRecipe>
        surfaces;  // that nothing moves: of these recipes what makes a surface, its look and feel
    std::vector<ColliderRecipe> colliders;
    std::vector<MoveRecipe> moves;
    std::vector<ToolRecipe> tools;
    std::vector<std::string> notes;  // what looks wrong in the file: a number whose unit may be another
    /// The files that its paths were read from.
    std::vector<std::filesystem::path> path_files;
};

/// Where up is: as the camera says, else against gravity, else along y. Unit.
vec3 sky(const Scene& scene);

/// A change from outside the file: `body.brain.nodes=5000`. `collider.3={ plane = {} }` adds a third of two.
/// One that names another source for a body (volume, surface, dims, cloth) takes away what was said of the
/// old one: its file, iso, units and maps.
using Change = std::string;

/// A scene before it is read, so that it can be changed, read again and saved.
struct SceneText {
    std::string text;
    std::string name;              // of its file, or of a shipped scene; for messages
    std::filesystem::path folder;  // that files are named from
};

/// The text of a scene: the name of a shipped scene, the path of a TOML file; or of a mesh or a volume, which
/// becomes one soft body of 0.2 m that is held below. Throws Error if there is none, or the name's ending
/// says nothing.
SceneText find_scene(const std::string& file_or_name);

/// Its text with changes made, to be saved: TOML that reads as the same scene. Comments, and the order of
/// keys, are lost. Throws Error.
std::string changed(const SceneText& scene, std::span<const Change> changes);

/// Reads a scene that find_scene() finds. Changes are made before it is
/// checked. Throws Error with the file, the line and the nearest known key where something does not fit.
Scene read_scene(const std::string& file_or_name, std::span<const Change> changes = {});

/// The same from a text; `name` is used in messages, and files are looked for in `folder`.
Scene parse_scene(const std::string& text, const std::string& name, const std::filesystem::path& folder,
                  std::span<const Change> changes = {});

inline Scene parse_scene(const SceneText& scene, std::span<const Change> changes = {}) {
    return parse_scene(scene.text, scene.name, scene.folder, changes);
}

/// A scene that comes with Palpate.
struct ShippedScene {
    std::string name;
    std::string text;
    std::string about;  // its first line of comment
};
const std::vector<ShippedScene>& shipped_scenes();

/// Finds a file or a folder that a scene names: as it stands if absolute, else in the scene's folder, in the
/// folder that the variable PALPATE_DATA names, or where Debian's mricron-data puts its templates. Throws
/// Error.
std::filesystem::path find_data(const std::string& name, const std::filesystem::path& folder);
bool is_found(const std::string& name, const std::filesystem::path& folder);
/// What to do where it is not found: the file beside the scene whose name is nearly that, or where files go.
std::string remedy_for_missing(const std::string& name, const std::filesystem::path& folder);

}  // namespace palpate
