#include "palpate/solver/schedule.h"

namespace palpate {

bool needs(const Scheme& scheme, StateBuffer where) {
    switch (where) {
        case current:
        case between:
            return true;
        case further:
            return scheme.stages.size() > 2;
        case sum:
            return scheme.stages.front().part > 0;
    }
    return false;
}

}  // namespace palpate
