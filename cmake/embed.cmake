# Writes the text of IN as one C++ raw string literal to OUT. GLSL knows no #include: the files that IN includes, named from
# the folder ROOT, take its place.
file(READ ${IN} text)
while(text MATCHES "#include \"([^\"]+)\"\n")
    set(line "${CMAKE_MATCH_0}")
    file(READ ${ROOT}/${CMAKE_MATCH_1} included)
    string(REPLACE "${line}" "${included}" text "${text}")
endwhile()
file(WRITE ${OUT} "R\"TEXT(${text})TEXT\"\n")
