// obstacles.inl: what a node does not enter. It stands after node.inl, in the same words and the same places.

// Where a node is in an obstacle.
struct Contact {
    Real3 normal;  // unit, the way out
    Real  depth;   // m; not above 0: it does not touch
};

FN Real3 into(Obstacle o, Real3 p) {
    return Real3(dot(xyz(o.x), p) + Real(o.x.w), dot(xyz(o.y), p) + Real(o.y.w), dot(xyz(o.z), p) + Real(o.z.w));
}
FN Real3 out_of(Obstacle o, Real3 v) { return v.x * xyz(o.x) + v.y * xyz(o.y) + v.z * xyz(o.z); }

FN Real3 surface_velocity(Obstacle o, Real3 p) { return xyz(o.velocity) + cross(xyz(o.spin), p - xyz(o.place)); }

// Where a node was when the step began, as the obstacle saw it from where that was then.
FN Real3 earlier(Obstacle o, Real3 was) { return into(o, was + Real(pass.duration) * surface_velocity(o, was)); }

FN Real signed_one(Real a) { return select(a < Real(0.0f), Real(-1.0f), Real(1.0f)); }

// Outside the box's core the way out leads away from the nearest point of the core, inside it through the nearest
// face; on it too, where the former is lost in rounding.
FN Contact in_round_box(Obstacle o, Real3 p) {
    Real3 side = Real3(signed_one(p.x), signed_one(p.y), signed_one(p.z));
    Real3 q = Real3(side.x * p.x, side.y * p.y, side.z * p.z) - xyz(o.size);
    Real3 beyond = Real3(max(q.x, Real(0.0f)), max(q.y, Real(0.0f)), max(q.z, Real(0.0f)));
    Real most = max(q.x, max(q.y, q.z)), one = Real(1.0f), none = Real(0.0f), hair = Real(1e-7f);
    Real x = select(q.x < most, none, one), y = select(q.y < most, none, one - x), z = one - x - y;
    Real square = squared(beyond), inverse = inversesqrt(square);
    Contact contact;
    contact.depth = Real(o.size.w) - select(most > hair, square * inverse, most);
    contact.normal = Real3(side.x * select(most > hair, inverse * beyond.x, x),
                           side.y * select(most > hair, inverse * beyond.y, y),
                           side.z * select(most > hair, inverse * beyond.z, z));
    return contact;
}

// A node stays on the side of a triangle where it was; what crossed it, or came near, above its area touches.
FN Contact at_triangle(Real3 was, Real3 p, Real3 a, Real3 b, Real3 c) {
    Real3 normal = unit(cross(b - a, c - a));
    Real height = dot(p - a, normal), before = dot(was - a, normal);
    Real side = signed_one(before);
    Real part = select(height * side < Real(0.0f), before * (Real(1.0f) / (before - height)), Real(1.0f));
    Real3 at = was + part * (p - was);
    Real left_of_ab = dot(cross(b - a, at - a), normal), left_of_bc = dot(cross(c - b, at - b), normal);
    Real within = min(min(left_of_ab, left_of_bc), dot(cross(a - c, at - c), normal));
    // Triangles overlap a little, so that rounding leaves no seam between them.
    Real hair = Real(-1e-4f) * dot(cross(b - a, c - a), normal);
    Contact contact;
    contact.normal = side * normal;
    contact.depth = select(within < hair, Real(-1.0f), -side * height);
    return contact;
}

FN Contact deeper(Contact a, Contact b) {
    a.normal = select(b.depth > a.depth, b.normal, a.normal);
    a.depth = max(a.depth, b.depth);
    return a;
}

// With a half-space, a box or a field, at a point of its frame.
FN Contact contact_at(Obstacle o, Real3 p) {
    Contact contact;
    contact.normal = Real3(0.0f, 1.0f, 0.0f);
    contact.depth = -p.y;
    if (o.kind.x == round_box) contact = in_round_box(o, p);
    if (o.kind.x == field) {
        contact.depth = -distance_at(o.kind.y, p);
        if (any_node(contact.depth + Real(o.place.w) > Real(0.0f))) contact.normal = unit(uphill_at(o.kind.y, p));
    }
    contact.depth += Real(o.place.w);
    return contact;
}

FN Contact with_triangles(Obstacle o, Real3 was, Real3 p) {
    Contact contact;
    contact.normal = Real3(0.0f, 1.0f, 0.0f);
    contact.depth = Real(-1.0f);
    for (int i = o.kind.y; i < o.kind.y + o.kind.z; i += 3)
        contact = deeper(contact, at_triangle(was, p, corner(i), corner(i + 1), corner(i + 2)));
    contact.depth += Real(o.place.w);
    return contact;
}

// What a node met first on its way: continuous collision detection. It goes on as far as nothing is in the way, again
// and again: to the plane that touches a box where it is nearest, since the box lies behind it; in a field, which may
// have hollows, by the distance alone. The plane where it arrives keeps it out.
ASIDE Contact met_on_the_way(Obstacle o, Real3 was, Real3 p) {
    Real3 way = p - was, at = was;
    Real none = Real(0.0f), one = Real(1.0f), part = none, length = squared(way) * inversesqrt(squared(way));
    Contact contact = contact_at(o, at);
    for (int i = 0; i < 8; ++i) {
        Real nearing = length;
        if (o.kind.x == round_box) nearing = max(-dot(way, contact.normal), Real(1e-20f));
        part = min(part + max(-contact.depth, none) * (one / nearing), one);
        at = was + part * way;
        contact = contact_at(o, at);
    }
    if (o.kind.x == field) contact.normal = unit(uphill_at(o.kind.y, at));
    Real arrived = contact.depth + Real(0.01f) * length, left = dot(way - part * way, contact.normal);
    contact.depth = select(arrived > none, contact.depth - left, Real(-1.0f));
    return contact;
}

FN Contact contact_with(Obstacle o, Real3 was, Real3 now) {
    Real3 p = into(o, now);
    Contact contact;
    if (o.kind.x == polygon)
        contact = with_triangles(o, earlier(o, was), p);
    else
        contact = contact_at(o, p);
    Real too_far = squared(now - was) - Real(o.spin.w * o.spin.w);
    if (any_node(too_far > Real(0.0f))) {
        Contact met = met_on_the_way(o, earlier(o, was), p);
        met.depth = select(too_far > Real(0.0f), met.depth, Real(-1.0f));
        contact = deeper(contact, met);
    }
    contact.normal = out_of(o, contact.normal);
    return contact;
}

// Lifts a node out and stops its motion inward. Dry friction takes from its motion along the surface as much speed
// as friction x the speed it lost inward, and as much way as friction x the depth: the same force, seen twice.
ASIDE Node push_out(Node node, Real3 was, Obstacle o) {
    Contact contact = contact_with(o, origin() + was, origin() + node.position);
    if (!any_node(contact.depth > Real(0.0f))) return node;
    Real3 normal = contact.normal, surface = surface_velocity(o, origin() + node.position);
    Real3 speed = node.velocity - surface, way = node.position - was - Real(pass.duration) * surface;
    Real inward = min(dot(speed, normal), Real(0.0f)), friction = Real(o.velocity.w), one = Real(1.0f);
    speed -= dot(speed, normal) * normal;
    way -= dot(way, normal) * normal;
    Real slowed = min(-inward * friction * inversesqrt(squared(speed)), one);
    Real held_back = min(contact.depth * friction * inversesqrt(squared(way)), one);
    Real touches = select(contact.depth > Real(0.0f), one, Real(0.0f));
    if (pass.last > 0) node.velocity -= touches * (inward * normal + slowed * speed);
    node.position += touches * (contact.depth * normal - held_back * way);
    return node;
}

// The obstacles, at the end of a pass of a step that began at `was`. They move nodes in each pass, else the neighbours
// of a node that rests on something would see it sink in between; they stop them in the last one, else what stopped
// in between would not be found to have come in.
FN Node collide(Node node, Real3 was) {
    if (OBSTACLES == 0) return node;
    Node pushed = node;
    for (int i = 0; i < OBSTACLES; ++i) pushed = push_out(pushed, was, pass.obstacle[i]);
    node.position = select(node.inverse_mass > Real(0.0f), pushed.position, node.position);
    node.velocity = select(node.inverse_mass > Real(0.0f), pushed.velocity, node.velocity);
    return node;
}
