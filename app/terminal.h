#pragma once
#include "palpate/base/progress.h"

#include <string>
#include <vector>

/// Shows progress as one line that renews itself, on a terminal; says nothing in a pipe.
palpate::Progress terminal_progress();

/// Wipes that line.
void end_progress();

/// Prints rows of two columns, the first padded to the widest.
void print_table(const std::vector<std::pair<std::string, std::string>>& rows);

/// 1234567 as "1,234,567".
std::string grouped(long long number);
