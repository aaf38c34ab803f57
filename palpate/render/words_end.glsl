// Behind this, the words of words.glsl mean nothing again.
#undef FN
#undef Real
#undef Real3
#undef select
#undef x_of
