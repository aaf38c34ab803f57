# Shows Doxygen the comments behind fields and enumerators, `float step;  // s`, in the form that it knows, `///< s`;
# and the lines below such a comment that go on with it, in the same column.
{
    code = match($0, /[;,] +\/\/ /)
    here = index($0, "// ")
    if (code && $0 !~ /\/\/\//) { column = here; sub(/\/\/ /, "///< ") }
    else if (here && here == column && $0 ~ /^ +\/\/ /) sub(/\/\/ /, "///< ")
    else column = 0
    print
}
