# Writes the text of IN as one C++ raw string literal to OUT.
file(READ ${IN} text)
file(WRITE ${OUT} "R\"TEXT(${text})TEXT\"\n")
