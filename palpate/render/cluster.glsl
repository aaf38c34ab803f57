// What clusters of all kinds share.

// As Cluster in culling.cpp.
struct Cluster {
    // The index after its last part, and after the last corner of its triangles; they begin where those of the
    // cluster before end.
    int parts_end, corners_end;
    // The cone of its triangles' normals at rest; the largest, over its triangles, of the sum of the two shorter
    // sides over twice the area, and of 1 over twice the area. In cells; 0 where there is no such cone.
    float axis[3], cosine, sine;
    float sharpness, smallness;
};

uniform mat4 to_clip;
uniform vec4 eye;  // see View

struct Box {  // axis-aligned bounding box
    vec3 low, high;
};

Box no_box() { return Box(vec3(3e38), vec3(-3e38)); }

void include(inout Box box, vec3 p) {
    box.low = min(box.low, p);
    box.high = max(box.high, p);
}
