// What all kinds of clusters have.

// As Cluster in culling.cpp.
struct Cluster {
    // Where its parts end, and the corners of its triangles; they begin where the last cluster's end.
    int parts_end, corners_end;
    // The cone of its triangles' normals at rest, and of each triangle the two shorter sides and 1 over its area,
    // twice: the largest. In cells; 0 where there is no such cone.
    float axis[3], cosine, sine;
    float sharpness, smallness;
};

uniform mat4 to_clip;
uniform vec4 eye;  // see View

struct Box {
    vec3 low, high;
};

Box no_box() { return Box(vec3(3e38), vec3(-3e38)); }

void include(inout Box box, vec3 p) {
    box.low = min(box.low, p);
    box.high = max(box.high, p);
}
