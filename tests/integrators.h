#pragma once
#include "palpate/body/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

// For tests that run with every integrator: all of them, and how a test is named after one.

inline std::vector<palpate::Integrator> every_integrator() {
    std::vector<palpate::Integrator> all;
    for (const auto& named : names(palpate::Integrator{})) all.push_back(named.value);
    return all;
}

inline std::string test_name(const ::testing::TestParamInfo<palpate::Integrator>& info) {
    std::string name(palpate::name_of(info.param));
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}
