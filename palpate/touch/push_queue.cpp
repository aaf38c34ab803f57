#include "palpate/touch/push_queue.h"

namespace palpate {

void PushQueue::add(const Push& push) noexcept {
    Waiting& one = waiting_[std::size_t(push.surface)];
    const dvec3 before = one.any ? one.sum.impulse : dvec3(0);
    one = {push, true};
    one.sum.impulse += before;
}

void PushQueue::send() noexcept {
    for (Waiting& one : waiting_)
        if (one.any) one.any = !ring_.put(one.sum);
}

}  // namespace palpate
