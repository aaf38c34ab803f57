#pragma once
#include "palpate/base/clock.h"

#include <exception>
#include <functional>
#include <new>
#include <string>

namespace palpate {

/// The latest message to the user.
struct Message {
    std::string text;
    bool bad = false;
    double since = 0;  // s

    void say(const std::string& what, bool is_bad = false) { *this = {what, is_bad, now()}; }

    /// Tries a user's request: if it fails, the message says why, and this returns false.
    bool attempt(const std::function<void()>& what) noexcept try {
        what();
        return true;
    } catch (const std::bad_alloc&) {
        say("not enough memory in this machine; use fewer nodes or faces", true);
        return false;
    } catch (const std::exception& error) {
        say(error.what(), true);
        return false;
    }
};

}  // namespace palpate
