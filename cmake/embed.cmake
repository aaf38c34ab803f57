# Writes the text of IN as one C++ raw string literal to OUT. GLSL has no #include, so each
# of them is replaced by the file, whose name is relative to the folder ROOT.
file(READ ${IN} text)
while(text MATCHES "#include \"([^\"]+)\"\n")
    set(line "${CMAKE_MATCH_0}")
    file(READ ${ROOT}/${CMAKE_MATCH_1} included)
    string(REPLACE "${line}" "${included}" text "${text}")
endwhile()
file(WRITE ${OUT} "R\"TEXT(${text})TEXT\"\n")
