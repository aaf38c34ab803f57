// Undefines the macros of macros.glsl.
#undef FN
#undef Real
#undef Real3
#undef select
#undef x_of
