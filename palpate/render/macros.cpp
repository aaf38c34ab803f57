#include "palpate/render/macros.h"

namespace palpate {

const char* const macros_glsl =
#include "embedded/macros.glsl.h"
    ;
const char* const macros_end_glsl =
#include "embedded/macros_end.glsl.h"
    ;

}  // namespace palpate
