// pass_node.glsl: one pass for one node, between a backend's loading and storing. After node.inl and obstacles.inl.

// A node as it is kept.
struct Kept {
    vec4 position, velocity;  // see node_access.glsl
};

Node node_of(Kept kept) {
    Node node;
    node.position = kept.position.xyz;
    node.velocity = velocity_of(kept.velocity);
    node.inverse_mass = kept.position.w;
    return node;
}

// `was`: where the node was when the step began.
Kept pass_node(Kept now, Kept start, vec3 was, inout Kept sum) {
    if (now.position.w < 0) return now;
    if (pass.place_shift.w > 0) {
        now.position.xyz -= pass.place_shift.xyz;
        now.velocity.xyz -= pass.speed_shift.xyz;
        return now;
    }
    Node node = node_of(now);
    vec3 change = vec3(0);
    if (pass.kick > 0) change = resisted(node_of(start), node.position, acceleration(node));
#ifdef SUMS
    if (pass.part > 0) {
        Node total = collect(node_of(sum), node, change);
        sum.position.xyz = total.position;
        sum.velocity.xyz = total.velocity;
    }
#endif
    Node moved = collide(integrate(node_of(start), node, change), was);
    now.position.xyz = moved.position;
    now.velocity.xyz = moved.velocity;
#ifdef GUIDES
    if (pass.last > 1 && now.velocity.w >= 0) {  // takes the rounding of many steps away
        vec4 to = texelFetch(guides, 2 * int(now.velocity.w) + 1);
        if (to.w > 0) now.position.xyz = to.xyz;
    }
#endif
    return now;
}
