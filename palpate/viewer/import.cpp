#include "palpate/viewer/import.h"

#include "palpate/base/error.h"

#include <chrono>

namespace palpate {
Import::Import(SceneText source, std::vector<Change> changes)
    : name_(source.name),
      work_(std::async(std::launch::async, [this, source = std::move(source), changes = std::move(changes)] {
          return prepare(source, changes, [this](std::string_view doing, double fraction) {
              if (cancelled_) throw Error("cancelled", name_, "open it again");
              const std::scoped_lock lock(mutex_);
              state_ = {std::string(doing), fraction};
          });
      })) {}

Import::~Import() {
    cancelled_ = true;
    if (work_.valid()) work_.wait();
}

Import::State Import::state() const {
    const std::scoped_lock lock(mutex_);
    return state_;
}

bool Import::done() const {
    return work_.valid() && work_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace palpate
