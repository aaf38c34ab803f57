// Bullet's soft body, if libbullet-dev was installed when Palpate was built.
#include "bench/speed/speed.h"

#ifdef PALPATE_BULLET
#include "palpate/base/clock.h"

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodySolvers.h>

#include <memory>
#endif

namespace palpate::speed {

#ifdef PALPATE_BULLET
namespace {

// In its fastest configuration: one iteration over the links, and no collisions.
struct Soft {
    btSoftBodyWorldInfo world;
    std::unique_ptr<btSoftBody> body;

    explicit Soft(const Body& of) {
        std::vector<btVector3> at;
        std::vector<btScalar> masses;
        for (std::size_t i = 0; i < of.count(); ++i) {
            at.emplace_back(of.positions[i].x, of.positions[i].y, of.positions[i].z);
            masses.push_back(of.inverse_mass[i] > 0 ? 1 / of.inverse_mass[i] : 0);
        }
        world.m_gravity = btVector3(0, -9.81f, 0);
        body = std::make_unique<btSoftBody>(&world, int(of.count()), at.data(), masses.data());
        for (uvec2 ends : spring_ends(of)) body->appendLink(int(ends.x), int(ends.y));
        body->m_cfg.piterations = 1;
        body->m_cfg.collisions = 0;
        body->m_cfg.kDP = 0.01f;
    }

    void links() { btSoftBody::PSolve_Links(body.get(), 1, 1); }
    void step() {
        body->predictMotion(1e-3f);
        body->solveConstraints();
        body->integrateMotion();
    }
};

}  // namespace

std::vector<Case> bullet(const Body& body) {
    auto soft = std::make_shared<Soft>(body);
    soft->step();  // before its first step its links have no weights, and it skips them
    const double nodes = double(body.count()), links = double(soft->body->m_links.size()) / nodes;
    auto timed = [=](int times, void (Soft::*once)()) {
        return [=] {
            const double start = now();
            for (int i = 0; i < times; ++i) (*soft.*once)();
            return Work{now() - start, times * nodes};
        };
    };
    return {{"Bullet: all links once", timed(10, &Soft::links), links, 0, 0, 1},
            {"Bullet: a step", timed(5, &Soft::step), links, 0, 0, 1}};
}
#else
std::vector<Case> bullet(const Body&) { return {}; }
#endif

}  // namespace palpate::speed
