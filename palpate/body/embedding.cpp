#include "palpate/body/embedding.h"

#include "palpate/base/error.h"
#include "palpate/body/embedding_parts.h"

namespace palpate {
namespace {

std::string name_or(const Body& body, const char* otherwise) {
    return body.name.empty() ? otherwise : body.name;
}

void check(const Body& body, Mapping mapping) {
    if (!body.cells.empty()) return;
    if (mapping == Mapping::trilinear)
        throw Error("no cell for the trilinear mapping to hang a surface in", name_or(body, "the body"),
                    "use the mapping frames, or a lattice at least two nodes thick along each axis");
    if (body.faces.empty())
        throw Error("a body with neither filled cells nor faces", name_or(body, "the lattice"),
                    "make it at least two nodes thick along each axis to hang a surface on it, or give a net "
                    "faces");
}

Mapping best_for(const Body& body) { return body.cells.empty() ? Mapping::frames : Mapping::trilinear; }

}  // namespace

Embedding embed(const Mesh& surface, const Body& body, Mapping mapping) {
    if (surface.positions.empty()) return {};
    check(body, mapping);
    if (surface.normals.size() != surface.positions.size()) {
        Mesh with_normals = surface;
        compute_normals(with_normals);
        return embed(with_normals, body, mapping);
    }
    if (mapping == Mapping::automatic) mapping = best_for(body);
    const bool has_tangents = surface.tangents.size() == surface.positions.size();
    const std::vector<vec4> tangents = has_tangents ? surface.tangents : std::vector<vec4>();
    if (mapping == Mapping::trilinear) return {embed_in_cells(surface, body), tangents};
    if (mapping == Mapping::frames) return {embed_on_frames(surface, body), tangents};
    auto vertices = embed_on_triangles(surface, body, mapping);
    auto in_bases = tangents_in(vertices, body, tangents);
    return {std::move(vertices), std::move(in_bases)};
}

void deform(const Embedding& embedding, const Nodes& nodes, std::vector<vec3>& positions,
            std::vector<vec3>& normals, std::vector<vec4>* tangents) {
    std::size_t count = 0;
    if (const auto* framed = std::get_if<Framed>(&embedding.vertices)) count = framed->vertices.size();
    if (const auto* in_cells = std::get_if<std::vector<InCell>>(&embedding.vertices))
        count = in_cells->size();
    if (const auto* on = std::get_if<std::vector<OnTriangle>>(&embedding.vertices)) count = on->size();
    positions.resize(count);
    normals.resize(count);
    if (tangents) tangents->resize(embedding.tangents.size());
    const bool carry = tangents && !tangents->empty();
    const Carried out{positions, normals, embedding.tangents, carry ? tangents->data() : nullptr};
    std::visit([&](const auto& vertices) { deform(vertices, nodes, out); }, embedding.vertices);
}

std::vector<vec3> approximate_normals(const Body& body, std::span<const vec3> positions) {
    const Table springs = table(body);
    std::vector<vec3> normals(body.count(), vec3(0));
    for (std::size_t i = 0; i < body.count(); ++i) {
        const auto ties = springs.of(i);
        auto toward = [&](int t) { return ties[t].to < 0 ? vec3(0) : positions[ties[t].to] - positions[i]; };
        vec3 round(0);
        for (int t = 0; t < body.fan; ++t) round += glm::cross(toward(t), toward((t + 1) % body.fan));
        normals[i] = direction(round, vec3(0));
        if (body.fan == 0)
            for (int t = 0; t < springs.width; ++t)
                if (ties[t].to >= 0) normals[i] -= ties[t].share * direction(toward(t), vec3(0));
    }
    return normals;
}

}  // namespace palpate
