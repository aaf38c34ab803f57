#pragma once
#include "palpate/base/progress.h"

#include <string>
#include <vector>

/// Shows progress on a terminal, as one line that is rewritten in place; prints nothing into a pipe.
palpate::Progress terminal_progress();

/// Clears that line.
void end_progress();

/// Prints rows of two columns, the first padded to the widest.
void print_table(const std::vector<std::pair<std::string, std::string>>& rows);

/// 1234567 as "1,234,567".
std::string grouped(long long number);
