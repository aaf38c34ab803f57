#pragma once
// Debian's ITK wants to be compiled by g++ only, and asks for its name once, in this header: there clang is
// g++ 12.
#pragma push_macro("__clang__")
#pragma push_macro("__GNUC__")
#undef __clang__
#undef __GNUC__
#define __GNUC__ 12
#include <itk_compiler_detection.h>
#pragma pop_macro("__GNUC__")
#pragma pop_macro("__clang__")
