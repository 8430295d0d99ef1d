#pragma once
// How far a result is from the truth: the figures of docs/verify.md.

#include <cstdint>
#include <span>

#include "truth/light_truth.h"

namespace gnomon::renderer {

/// What is wrong with one pixel and light.
enum class PairError : std::uint8_t {
    NotCounted,
    None,
    Acne,
    Leak,
    ContactLeak,
    EdgeError,
    PenumbraError,  ///< soft truth is neither lit nor dark, and the result is off by more than one half
};

/// A blocker nearer than this touches the receiver.
inline constexpr float kContactMetres = 0.05f;

/// `soft`: judged against soft truth (PCSS), else against hard truth. A `result` below 0 is not counted.
[[nodiscard]] PairError errorOf(const PixelTruth& truth, float result, bool soft);

/// No edge, and off by more than kFaint, but not so far that errorOf() calls it acne or a leak.
[[nodiscard]] bool isFaintAcne(const PixelTruth& truth, float result, bool soft);
[[nodiscard]] bool isFaintLeak(const PixelTruth& truth, float result, bool soft);

/// Sums over pairs of pixel and light; shares of them.
struct Figures {
    std::uint64_t pairs = 0;  ///< counted
    std::uint64_t away = 0, lit = 0, dark = 0, edges = 0, contacts = 0;
    std::uint64_t acne = 0, leak = 0, contactLeak = 0, edgeError = 0;
    std::uint64_t penumbraError = 0;
    std::uint64_t undecided = 0;  ///< no edge, but soft truth that is neither lit nor dark: no acne or leak there
    /// Of result - truth, edges included: over all pairs by hard truth, over the subset by soft truth.
    std::uint64_t comparedPairs = 0;
    double absoluteError = 0.0;
    std::uint64_t faintAcne = 0, faintLeak = 0;      ///< off by more than 0.1, but not by so much as acne and leak
    std::uint64_t softPairs = 0, penumbraPairs = 0;  ///< with soft truth, of the subset; of them in penumbra
    double squaredError = 0.0, fourthPowers = 0.0;   ///< of result - soft truth, over the penumbra
    double ssimSum = 0.0;                            ///< weighted by pixels in penumbra
    std::uint64_t ssimPixels = 0;

    Figures& operator+=(const Figures& other);
    [[nodiscard]] double share(std::uint64_t part) const {
        return pairs == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(pairs);
    }
    /// Of the pairs that a blocker touches.
    [[nodiscard]] double contactLeakOfContacts() const {
        return contacts == 0 ? 0.0 : static_cast<double>(contactLeak) / static_cast<double>(contacts);
    }
    /// Mean of |result - truth|: the one figure that nothing escapes. From 0 to 1.
    [[nodiscard]] double visibilityError() const {
        return comparedPairs == 0 ? 0.0 : absoluteError / static_cast<double>(comparedPairs);
    }
    [[nodiscard]] double penumbraRmse() const;
    /// 95 % confidence interval of penumbraRmse() by the choice of pixels.
    void penumbraRmseInterval(double& low, double& high) const;
    [[nodiscard]] double penumbraSsim() const;  ///< 1 where there is no penumbra
};

/// Of one light: opaque receivers and subsurface ones apart.
struct LightFigures {
    Figures opaque, subsurface;
    LightFigures& operator+=(const LightFigures& other);
    /// Share of all pairs on which acne and leak say nothing: edges, penumbrae, subsurface receivers.
    [[nodiscard]] double setAside() const;
    /// Wrong pairs among those that were set aside, as a share of them.
    [[nodiscard]] double wrongOfSetAside() const;
};

/// `result`: for each pixel of the picture, below 0 where it is not counted; soft truth completed for it.
[[nodiscard]] LightFigures figuresOf(const LightTruth& truth, std::span<const float> result, bool soft);

}  // namespace gnomon::renderer
