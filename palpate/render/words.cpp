#include "palpate/render/words.h"

namespace palpate {

const char* const words_glsl =
#include "embedded/words.glsl.h"
    ;
const char* const words_end_glsl =
#include "embedded/words_end.glsl.h"
    ;

}  // namespace palpate
