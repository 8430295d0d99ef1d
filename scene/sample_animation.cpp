// Source: glTF 2.0 specification, appendix C (step, linear, spherical linear and cubic spline interpolation).
#include "scene/sample_animation.h"

#include <algorithm>
#include <cmath>

namespace gnomon::renderer {
namespace {

template <class Number>
glm::dquat unitQuaternion(const Number* xyzw) {
    const glm::dquat q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
    const double length = glm::length(q);
    return length > 1.0e-12 ? q / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

void write(const glm::dquat& unit, std::span<double> out) {
    out[0] = unit.x;
    out[1] = unit.y;
    out[2] = unit.z;
    out[3] = unit.w;
}

struct Segment {
    std::size_t key = 0;  // the key at or before the time
    double part = 0.0;    // of the way to the next one
    double seconds = 0.0;
};

Segment segmentAt(const std::vector<float>& times, double seconds) {
    const auto after = std::upper_bound(times.begin(), times.end(), seconds,
                                        [](double t, float key) { return t < static_cast<double>(key); });
    if (after == times.begin()) return {};
    const auto key = static_cast<std::size_t>(after - times.begin()) - 1;
    if (after == times.end()) return {key, 0.0, 0.0};
    const double begin = times[key], length = static_cast<double>(*after) - begin;
    return {key, (seconds - begin) / length, length};
}

// Per key: in-tangent, value, out-tangent.
void sampleSpline(const AnimationChannel& channel, const Segment& s, std::span<double> out) {
    const std::size_t width = out.size();
    const float* here = channel.values.data() + s.key * 3 * width;
    const float* next = s.part > 0.0 ? here + 3 * width : here;
    const double t = s.part, t2 = t * t, t3 = t2 * t;
    for (std::size_t i = 0; i < width; ++i) {
        const double value = here[width + i], outTangent = here[2 * width + i];
        const double nextValue = next[width + i], nextInTangent = next[i];
        out[i] = (2.0 * t3 - 3.0 * t2 + 1.0) * value + s.seconds * (t3 - 2.0 * t2 + t) * outTangent +
                 (-2.0 * t3 + 3.0 * t2) * nextValue + s.seconds * (t3 - t2) * nextInTangent;
    }
}

}  // namespace

std::size_t channelWidth(const AnimationChannel& channel) {
    switch (channel.path) {
        case AnimationChannel::Path::Translation:
        case AnimationChannel::Path::Scale:
            return 3;
        case AnimationChannel::Path::Rotation:
            return 4;
        case AnimationChannel::Path::Weights:
            break;
    }
    const std::size_t perKey = channel.interpolation == AnimationChannel::Interpolation::CubicSpline ? 3 : 1;
    return channel.values.size() / channel.times.size() / perKey;
}

void sampleChannel(const AnimationChannel& channel, double seconds, std::span<double> out) {
    const bool rotation = channel.path == AnimationChannel::Path::Rotation;
    const Segment s = segmentAt(channel.times, seconds);
    if (channel.interpolation == AnimationChannel::Interpolation::CubicSpline) {
        sampleSpline(channel, s, out);
        if (rotation) write(unitQuaternion(out.data()), out);
        return;
    }
    const bool step = channel.interpolation == AnimationChannel::Interpolation::Step || s.part <= 0.0;
    const float* here = channel.values.data() + s.key * out.size();
    const float* next = step ? here : here + out.size();
    const double part = step ? 0.0 : s.part;
    if (rotation) {  // the shorter way round
        write(glm::normalize(glm::slerp(unitQuaternion(here), unitQuaternion(next), part)), out);
        return;
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double from = here[i], to = next[i];
        out[i] = from + part * (to - from);
    }
}

double loopedTime(const Animation& animation, double seconds) {
    const auto duration = static_cast<double>(animation.durationSeconds);
    if (!(duration > 0.0)) return 0.0;
    const double time = std::fmod(seconds, duration);
    return time < 0.0 ? time + duration : time;
}

}  // namespace gnomon::renderer
