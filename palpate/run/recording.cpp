#include "palpate/run/recording.h"

#include "palpate/base/error.h"
#include "palpate/base/files.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace palpate {
namespace {

using nlohmann::json;

constexpr int version = 1;
constexpr long most_frames = 100'000'000;  // weeks

json numbers(vec3 v) { return {v.x, v.y, v.z}; }

json of_press(const Press& press) {
    return {{"centre", numbers(press.centre)},
            {"velocity", numbers(press.velocity)},
            {"radius", press.radius},
            {"stiffness", press.stiffness},
            {"friction", {press.friction.still, press.friction.sliding}},
            {"damping", press.damping}};
}

json of_pull(const BodyPush& pull) {
    return {{"body", pull.body},
            {"node", pull.push.node},
            {"to", numbers(pull.push.to)},
            {"velocity", numbers(pull.push.velocity)},
            {"stiffness", pull.push.stiffness}};
}

json of_input(const Input& input) {
    json one = {{"at", input.at}};
    if (const auto* hands = std::get_if<Interaction>(&input.what)) {
        for (const Press& press : hands->presses) one["press"].push_back(of_press(press));
        for (const BodyPush& pull : hands->pulls) one["pull"].push_back(of_pull(pull));
        if (input.slices != slices_per_frame) one["slices"] = input.slices;
    } else if (const auto* set = std::get_if<SetChanges>(&input.what)) {
        one["changes"] = set->changes;
    } else {
        one["return"] = true;
    }
    return one;
}

// ---- reading; errors are thrown as nlohmann's exceptions or as a text ----

float finite(const json& value) {
    constexpr double most = 1e30;  // so that squares stay finite
    const auto number = value.get<double>();
    if (!(std::abs(number) <= most)) throw std::string("a number that is not finite");
    return float(number);
}

vec3 to_vector(const json& value) {
    if (!value.is_array() || value.size() != 3) throw std::string("a place that is not three numbers");
    return {finite(value[0]), finite(value[1]), finite(value[2])};
}

// Older recordings have no friction and no damping.
Press to_press(const json& one) {
    const json friction = one.value("friction", json{0, 0});
    const Press press{to_vector(one.at("centre")),
                      to_vector(one.at("velocity")),
                      finite(one.at("radius")),
                      finite(one.at("stiffness")),
                      {finite(friction.at(0)), finite(friction.at(1))},
                      finite(one.value("damping", json(0)))};
    const auto [still, sliding] = press.friction;
    if (!(press.radius > 0) || !(press.stiffness >= 0) || !(press.damping >= 0) || !(sliding >= 0) ||
        !(sliding <= still))
        throw std::string("an invalid press");
    return press;
}

Interaction to_hands(const json& one) {
    Interaction hands;
    for (const json& press : one.value("press", json::array())) hands.presses.push_back(to_press(press));
    for (const json& pull : one.value("pull", json::array()))
        hands.pulls.push_back({pull.at("body").get<std::size_t>(),
                               {pull.at("node").get<int>(), to_vector(pull.at("to")),
                                to_vector(pull.at("velocity")), finite(pull.at("stiffness"))}});
    return hands;
}

Input to_input(const json& one) {
    Input input{one.at("at").get<long>(), {}};
    if (one.contains("changes"))
        input.what = SetChanges{one["changes"].get<std::vector<Change>>()};
    else if (one.contains("return"))
        input.what = ReturnToGood{};
    else
        input.what = to_hands(one);
    input.slices = one.value("slices", slices_per_frame);
    if (input.slices < 1 || input.slices > slices_per_frame) throw std::string("an invalid number of slices");
    return input;
}

Recording to_recording(const json& all) {
    if (all.value("palpate-recording", 0) != version) throw std::string("this is no recording of version 1");
    const json& scene = all.at("scene");
    Recording recording;
    recording.scene = {scene.at("text"), scene.at("name"), scene.at("folder").get<std::string>()};
    recording.changes = all.at("changes").get<std::vector<Change>>();
    recording.advances = all.at("frames").get<long>();
    if (recording.advances < 0 || recording.advances > most_frames)
        throw std::string("an invalid number of frames");
    recording.fingerprint = all.at("fingerprint");
    for (const json& one : all.at("inputs")) {
        recording.inputs.push_back(to_input(one));
        const auto& list = recording.inputs;
        if (list.back().at < (list.size() > 1 ? list[list.size() - 2].at : 0))
            throw std::string("inputs that go back in time");
        if (list.back().at > recording.advances) throw std::string("inputs after the last frame");
    }
    return recording;
}

}  // namespace

void write_recording(const Recording& recording, const std::filesystem::path& file) {
    json all = {{"palpate-recording", version},
                {"scene",
                 {{"name", recording.scene.name},
                  {"folder", recording.scene.folder.string()},
                  {"text", recording.scene.text}}},
                {"changes", recording.changes},
                {"frames", recording.advances},
                {"fingerprint", recording.fingerprint},
                {"inputs", json::array()}};
    for (const Input& input : recording.inputs) all["inputs"].push_back(of_input(input));
    write_text(file, all.dump(1) + "\n");
}

Recording read_recording(const std::filesystem::path& file) {
    auto fail = [&](std::string_view what) -> Recording {
        throw Error(what, file.string(), "give a file that the viewer saved as a recording");
    };
    try {
        return to_recording(json::parse(read_text(file)));
    } catch (const json::exception& error) {
        return fail(error.what());
    } catch (const std::string& what) {
        return fail(what);
    }
}

}  // namespace palpate
