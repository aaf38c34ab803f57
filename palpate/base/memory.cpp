#include "palpate/base/memory.h"

#include <sys/resource.h>

#include <initializer_list>

namespace palpate {

std::size_t peak_memory() {
    std::size_t kilobytes = 0;
    for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage used{};
        getrusage(who, &used);
        kilobytes += std::size_t(used.ru_maxrss);
    }
    return 1024 * kilobytes;
}

}  // namespace palpate
