// Minutes of random input into the viewer's window on a virtual display; ends with 1 if memory grows.
//   viewer_soak [MINUTES] [SEED]
#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/files/write.h"
#include "palpate/viewer/window.h"
#include "tests/shapes.h"
#include "tests/viewer/display.h"

#include <fmt/format.h>
#include <malloc.h>
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

#include <cstdio>
#include <fstream>
#include <random>

namespace palpate {
namespace {

// The process's resident set, MB.
double resident() {
    malloc_trim(0);
    std::ifstream file("/proc/self/statm");
    double all = 0, pages = 0;
    file >> all >> pages;
    return pages * double(sysconf(_SC_PAGESIZE)) / 1e6;
}

// All keys that are bound, except those that write files.
constexpr KeySym keys[] = {XK_1, XK_2, XK_k, XK_space, XK_period, XK_r,        XK_f,      XK_Home,
                           XK_b, XK_w, XK_l, XK_n,     XK_Tab,    XK_question, XK_Escape, XK_space};
constexpr const char* scenes[] = {"box", "drape", "nodule", "flag", "catheter"};

class Soak {
 public:
    Soak(Window& window, Person& person, unsigned seed, std::filesystem::path folder)
        : window_(window), person_(person), random_(seed), folder_(std::move(folder)) {}

    bool act() {
        const vec2 to(below(window_.viewer().left() + window_.viewer().size().x),
                      below(window_.viewer().size().y));
        switch (below(40)) {
            default:
                person_.move(to);
                break;
            case 0:
            case 1:
            case 2:
            case 3:
                button(1, true);
                break;
            case 4:
            case 5:
            case 6:
                button(1, false);
                break;
            case 7:
                button(3, true);
                break;
            case 8:
            case 9:
                button(3, false);
                break;
            case 10:
            case 11:
                person_.button(below(2) ? 4 : 5, true);
                person_.button(4, false);
                person_.button(5, false);
                break;
            case 12:
            case 13:
            case 14:
                person_.key(keys[below(std::size(keys))]);
                break;
            case 15:
                person_.key(below(2) ? XK_z : XK_y, true);
                break;
            case 16:
                change();
                break;
            case 17:
                if (below(10) == 0) open();
                break;
            case 18:
                if (below(10) == 0) person_.resize(unsigned(1 + below(1000)), unsigned(1 + below(800)));
                break;
            case 19:
                if (below(6) == 0) look();
                break;
        }
        return window_.round();
    }

 private:
    int below(std::size_t count) {
        return int(std::uniform_int_distribution<std::size_t>(0, count - 1)(random_));
    }

    void button(unsigned number, bool down) { person_.button(number, down); }

    // As the controls do, and some changes that are invalid.
    void change() {
        const char* const changes[] = {"simulation.integrator=\"rk4\"",
                                       "simulation.integrator=\"verlet\"",
                                       "simulation.integrator=\"midpoint\"",
                                       "simulation.backend=\"reference\"",
                                       "simulation.backend=\"cpu\"",
                                       "simulation.backend=\"compute\"",
                                       "simulation.backend=\"feedback\"",
                                       "simulation.gravity=[0,-9.81,0]",
                                       "simulation.gravity=[3,9,0]",
                                       "simulation.step=\"auto\"",
                                       "simulation.step=0.004",
                                       "body.1.damping=1",
                                       "body.1.damping=10",
                                       "body.1.mapping=\"frames\"",
                                       "body.1.mapping=\"trilinear\"",
                                       "body.1.youngs_modulus=7000",
                                       "body.1.damping=-1",
                                       "nonsense",
                                       "wind={velocity=[3,0,0]}"};
        window_.viewer().change({changes[below(std::size(changes))]});
    }

    void open() {
        if (below(3) == 0) {
            const char* const files[] = {"ball.ply", "broken.ply", "broken.toml", "nowhere.obj"};
            window_.viewer().open_file(folder_ / files[below(std::size(files))]);
        } else {
            window_.viewer().open(find_scene(scenes[below(std::size(scenes))]));
        }
    }

    void look() {
        Options& options = window_.viewer().options;
        options.stereo = below(4) == 0;
        options.care = Care(below(3));
        options.paused = false;
        options.compared = {Compared::With(below(3)), Mapping(below(3)), Backend(below(2))};
        options.tip = 0.002f + 0.001f * float(below(30));
    }

    Window& window_;
    Person& person_;
    std::mt19937 random_;
    std::filesystem::path folder_;
};

int run(double minutes, unsigned seed) {
    const Xvfb xvfb;
    if (xvfb.name().empty()) {
        std::puts("not available: the program Xvfb");
        return 1;
    }
    setenv("DISPLAY", xvfb.name().c_str(), 1);
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / fmt::format("palpate-soak-{}", getpid());
    make_folder(folder);
    write_mesh(ellipsoid(vec3(0.1f), 20), folder / "ball.ply");
    write_text(folder / "broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
    write_text(folder / "broken.toml", "[[body]");
    Window window(ivec2(800, 600));
    window.viewer().folder = folder;
    Person person(xvfb.name());
    Soak soak(window, person, seed, folder);
    window.viewer().open(find_scene("box"));
    const double start = now(), length = 60 * minutes;
    double warm = 0, most = 0, reported = 0;
    long acts = 0;
    while (now() - start < length) {
        if (!soak.act()) {
            std::puts("the window closed by itself");
            return 1;
        }
        ++acts;
        const double time = now() - start;
        if (time < 0.3 * length || time - reported < length / 20) continue;
        reported = time;
        const double here = resident();
        if (time < 0.5 * length) warm = std::max(warm, here);
        most = std::max(most, here);
        fmt::print("{:5.1f} min  {} inputs  {:.0f} MB  {}\n", time / 60, acts, here,
                   window.viewer().message().text);
        std::fflush(stdout);
    }
    std::filesystem::remove_all(folder);
#ifdef __SANITIZE_ADDRESS__
    __lsan_do_leak_check();  // here, while the driver is loaded, so that its leaks bear its name
#endif
    fmt::print("{} inputs in {:.1f} minutes; memory: {:.0f} MB at most until the middle, {:.0f} MB after\n",
               acts, minutes, warm, most);
    return most > 1.25 * warm + 20 ? 1 : 0;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
    try {
        return palpate::run(argc > 1 ? std::atof(argv[1]) : 10, argc > 2 ? unsigned(std::atoi(argv[2])) : 1);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
