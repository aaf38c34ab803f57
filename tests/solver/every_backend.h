#pragma once
#include "palpate/solver/solver.h"
#include "tests/gl/with_context.h"

#include <memory>
#include <string>

namespace palpate {

/// A test on each backend; those of the GPU are skipped where there is no OpenGL.
class EveryBackend : public WithContext, public ::testing::WithParamInterface<Backend> {
 protected:
    void SetUp() override {
        if (on_gpu(GetParam())) WithContext::SetUp();
    }
    std::unique_ptr<Solver> make(const Body& body, Simulation simulation) const {
        simulation.backend = GetParam();
        return make_solver(body, simulation, context_ ? context() : nullptr);
    }
};

inline auto every_backend() {
    return ::testing::Values(Backend::reference, Backend::cpu, Backend::feedback, Backend::fragment,
                             Backend::compute);
}
inline std::string backend_name(const ::testing::TestParamInfo<Backend>& of) {
    return std::string(name_of(of.param));
}

}  // namespace palpate
