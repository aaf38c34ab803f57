#include "palpate/base/pipe.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(Pipe, CarriesBytesToAProgram) {
    Scratch scratch;
    const std::string text(300'000, 'z');
    Pipe pipe({"dd", "status=none", "of=" + (scratch / "out").string()});
    pipe.write(text.data(), text.size());
    pipe.finish();
    EXPECT_EQ(read_text(scratch / "out"), text);
}

TEST(Pipe, AProgramThatFailsOrEndsEarlyIsAnErrorAndNotADeath) {
    Pipe fails({"false"});
    EXPECT_THROW(fails.finish(), Error);
    Pipe ends({"true"});
    const std::string text(1 << 20, 'z');  // more than a pipe holds
    EXPECT_THROW(ends.write(text.data(), text.size()), Error);
    EXPECT_THROW(Pipe({"no-such-program-here"}), Error);
}

TEST(Pipe, KnowsWhatIsInstalled) {
    EXPECT_TRUE(has_program("sh"));
    EXPECT_FALSE(has_program("no-such-program-here"));
}

}  // namespace
}  // namespace palpate
