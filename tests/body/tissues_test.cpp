// The table of tissues: sensible, found by name, and the same as the page that explains it.
#include "palpate/body/tissues.h"

#include "palpate/base/files.h"
#include "palpate/body/body.h"
#include "palpate/body/lattice.h"
#include "tests/refusal.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

namespace palpate {
namespace {

TEST(Tissues, AreWithinTheirRanges) {
    EXPECT_GE(tissues().size(), 14u);
    for (const Tissue& one : tissues()) {
        SCOPED_TRACE(one.name);
        EXPECT_GT(one.low, 0);
        EXPECT_LE(one.low, one.youngs_modulus);
        EXPECT_LE(one.youngs_modulus, one.high);
        EXPECT_GT(one.poisson, 0);
        EXPECT_LT(one.poisson, 0.499f);
        EXPECT_GT(one.density, 100);
        EXPECT_LT(one.density, 1200);
        EXPECT_GT(one.damping, 0);
        EXPECT_FALSE(one.about.empty());
        EXPECT_NE(one.source.find(": "), one.source.npos) << "who measured, and how";
    }
}

TEST(Tissues, AreAsPublished) {
    EXPECT_FLOAT_EQ(tissue_named("liver").youngs_modulus, 6270);         // 3 × 2.09 kPa
    EXPECT_NEAR(tissue_named("heart").youngs_modulus, 10'500, 50);       // 3 × 1060 kg/m³ × (1.82 m/s)²
    EXPECT_NEAR(tissue_named("silicone").youngs_modulus, 118'000, 500);  // 10 psi = µ (2 − 1/4)
}

TEST(Tissues, AreFoundByTheirNames) {
    std::set<std::string_view> names;
    for (const Tissue& one : tissues()) {
        EXPECT_TRUE(names.insert(one.name).second) << one.name << " twice";
        EXPECT_EQ(&tissue_named(one.name), &one);
    }
    for (const char* word : {"no tissue \"livr\" in the list of tissues", "did you mean \"liver\"?", "skin"})
        expect_refused(word, [] { tissue_named("livr"); });
    EXPECT_EQ(refusal([] { tissue_named("concrete"); }).find("did you mean"), std::string::npos);
}

TEST(Tissues, MakeBodiesOfCells) {
    const Tissue& liver = tissue_named("liver");
    const Body body = lattice({4, 4, 4}, 0.01f, liver.material());
    const TissueCells* cells = tissue_of(body);
    ASSERT_NE(cells, nullptr);
    EXPECT_EQ(cells->youngs_modulus, liver.youngs_modulus);
    EXPECT_EQ(cells->poisson, liver.poisson);
    EXPECT_EQ(body.damping, liver.damping);
}

TEST(Tissues, AreThoseOfThePage) {
    const std::string page = read_text(PALPATE_SOURCE_DIR "/docs/tissues.md");
    for (const Tissue& one : tissues()) {
        const std::string row =
            fmt::format("| `{}` | {:.3g} ({:.3g} to {:.3g}) | {:.2f} | {} | {} | {} | {} |\n", one.name,
                        one.youngs_modulus / 1000, one.low / 1000, one.high / 1000, one.poisson, one.density,
                        one.damping, one.about, one.source);
        EXPECT_NE(page.find(row), page.npos) << "docs/tissues.md lacks\n" << row;
    }
}

}  // namespace
}  // namespace palpate
