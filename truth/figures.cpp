#include "truth/figures.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace gnomon::renderer {
namespace {

constexpr float kSoftLit = 0.99f, kSoftDark = 0.01f;

bool isCounted(const PixelTruth& truth, float result) {
    return truth.hard != HardTruth::NotCounted && result >= 0.0f;
}
bool isLit(const PixelTruth& truth, bool soft) {
    return soft ? truth.soft > kSoftLit : truth.hard == HardTruth::Lit;
}
bool isDark(const PixelTruth& truth, bool soft) {
    return soft ? truth.soft < kSoftDark : truth.hard != HardTruth::Lit;
}

// Smaller windows say nothing about structure.
constexpr std::uint64_t kLeastWindowPixels = 16;

bool inPenumbra(const PixelTruth& truth) {
    return truth.subset && truth.soft > 0.0f && truth.soft < 1.0f;
}

void add(Figures& f, const PixelTruth& truth, float result, bool soft) {
    ++f.pairs;
    f.away += truth.hard == HardTruth::Away;
    f.lit += truth.hard == HardTruth::Lit;
    f.dark += truth.hard == HardTruth::Dark;
    f.edges += truth.edge;
    f.contacts += truth.hard == HardTruth::Dark && truth.blockerMetres < kContactMetres;
    const PairError error = errorOf(truth, result, soft);
    f.acne += error == PairError::Acne;
    // A leak at a contact is both, unless it lies within an edge: then it is the contact's alone.
    f.leak += error == PairError::Leak || (error == PairError::ContactLeak && !truth.edge);
    f.contactLeak += error == PairError::ContactLeak;
    f.edgeError += error == PairError::EdgeError || (error == PairError::ContactLeak && truth.edge);
    f.penumbraError += error == PairError::PenumbraError;
    f.undecided += soft && !truth.edge && truth.soft >= kSoftDark && truth.soft <= kSoftLit;
    f.faintAcne += isFaintAcne(truth, result, soft);
    f.faintLeak += isFaintLeak(truth, result, soft);
    const bool hasSoft = truth.subset && truth.soft >= 0.0f;
    if (!soft || hasSoft) {
        const float right = soft ? truth.soft : truth.hard == HardTruth::Lit ? 1.0f : 0.0f;
        ++f.comparedPairs;
        f.absoluteError += std::abs(static_cast<double>(result) - static_cast<double>(right));
    }
    if (!hasSoft) return;
    ++f.softPairs;
    if (!inPenumbra(truth)) return;
    const double difference = static_cast<double>(result) - static_cast<double>(truth.soft);
    ++f.penumbraPairs;
    f.squaredError += difference * difference;
    f.fourthPowers += difference * difference * difference * difference;
}

// Of one tile of the subset. Source: Wang et al. 2004, "Image Quality Assessment: From Error Visibility to Structural
// Similarity", equation 13, over a window of 8x8 pixels, for a dynamic range of 1.
struct Window {
    double x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
    std::uint64_t pixels = 0, penumbra = 0;

    void add(double truth, double result, bool isPenumbra) {
        x += truth, y += result;
        xx += truth * truth, yy += result * result, xy += truth * result;
        ++pixels;
        penumbra += isPenumbra;
    }
    [[nodiscard]] double ssim() const {
        constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
        const auto n = static_cast<double>(pixels);
        const double mx = x / n, my = y / n;
        const double vx = xx / n - mx * mx, vy = yy / n - my * my, cov = xy / n - mx * my;
        return (2.0 * mx * my + c1) * (2.0 * cov + c2) / ((mx * mx + my * my + c1) * (vx + vy + c2));
    }
};

// The windows of one row of tiles.
class WindowRow {
public:
    explicit WindowRow(std::uint32_t widthPx) : windows_((widthPx + kSubsetTilePx - 1) / kSubsetTilePx) {}

    void add(std::uint32_t x, const PixelTruth& truth, float result) {
        windows_[x / kSubsetTilePx].add(static_cast<double>(truth.soft), static_cast<double>(result),
                                        inPenumbra(truth));
    }
    void closeInto(Figures& f) {
        for (Window& window : windows_) {
            if (window.penumbra != 0 && window.pixels >= kLeastWindowPixels) {
                f.ssimSum += window.ssim() * static_cast<double>(window.penumbra);
                f.ssimPixels += window.penumbra;
            }
            window = {};
        }
    }

private:
    std::vector<Window> windows_;
};

}  // namespace

PairError errorOf(const PixelTruth& truth, float result, bool soft) {
    if (!isCounted(truth, result)) return PairError::NotCounted;
    // Soft truth that other results asked for does not count: what one result is told must not depend on them.
    if (soft && !truth.subset && !disagrees(truth, result)) return PairError::None;
    if (isLit(truth, soft) && result < 0.5f) return truth.edge ? PairError::EdgeError : PairError::Acne;
    if (isDark(truth, soft) && result > 0.5f) {
        if (truth.blockerMetres < kContactMetres) return PairError::ContactLeak;
        return truth.edge ? PairError::EdgeError : PairError::Leak;
    }
    const bool between = soft && !isLit(truth, soft) && !isDark(truth, soft);
    if (between && std::abs(result - truth.soft) > 0.5f) return PairError::PenumbraError;
    return PairError::None;
}

bool isFaintAcne(const PixelTruth& truth, float result, bool soft) {
    return isCounted(truth, result) && !truth.edge && isLit(truth, soft) && result >= 0.5f && result < 1.0f - kFaint;
}

bool isFaintLeak(const PixelTruth& truth, float result, bool soft) {
    return isCounted(truth, result) && !truth.edge && isDark(truth, soft) && result <= 0.5f && result > kFaint;
}

Figures& Figures::operator+=(const Figures& o) {
    pairs += o.pairs, away += o.away, lit += o.lit, dark += o.dark, edges += o.edges, contacts += o.contacts;
    faintAcne += o.faintAcne, faintLeak += o.faintLeak;
    penumbraError += o.penumbraError, undecided += o.undecided;
    comparedPairs += o.comparedPairs, absoluteError += o.absoluteError;
    acne += o.acne, leak += o.leak, contactLeak += o.contactLeak, edgeError += o.edgeError;
    softPairs += o.softPairs, penumbraPairs += o.penumbraPairs;
    squaredError += o.squaredError, fourthPowers += o.fourthPowers;
    ssimSum += o.ssimSum, ssimPixels += o.ssimPixels;
    return *this;
}

double Figures::penumbraRmse() const {
    return penumbraPairs == 0 ? 0.0 : std::sqrt(squaredError / static_cast<double>(penumbraPairs));
}

void Figures::penumbraRmseInterval(double& low, double& high) const {
    low = high = 0.0;
    if (penumbraPairs == 0) return;
    const auto n = static_cast<double>(penumbraPairs);
    const double mean = squaredError / n, variance = std::max(fourthPowers / n - mean * mean, 0.0);
    const double margin = 1.96 * std::sqrt(variance / n);
    low = std::sqrt(std::max(mean - margin, 0.0));
    high = std::sqrt(mean + margin);
}

double Figures::penumbraSsim() const {
    return ssimPixels == 0 ? 1.0 : ssimSum / static_cast<double>(ssimPixels);
}

LightFigures& LightFigures::operator+=(const LightFigures& other) {
    opaque += other.opaque;
    subsurface += other.subsurface;
    return *this;
}

double LightFigures::setAside() const {
    const std::uint64_t all = opaque.pairs + subsurface.pairs;
    const std::uint64_t aside = opaque.edges + opaque.undecided + subsurface.pairs;
    return all == 0 ? 0.0 : static_cast<double>(aside) / static_cast<double>(all);
}

double LightFigures::wrongOfSetAside() const {
    const std::uint64_t aside = opaque.edges + opaque.undecided + subsurface.pairs;
    const std::uint64_t wrong = opaque.edgeError + opaque.penumbraError + subsurface.acne + subsurface.leak +
                                subsurface.edgeError + subsurface.penumbraError;
    return aside == 0 ? 0.0 : static_cast<double>(wrong) / static_cast<double>(aside);
}

LightFigures figuresOf(const LightTruth& truth, std::span<const float> result, bool soft) {
    LightFigures figures;
    WindowRow opaque(truth.extent.widthPx), subsurface(truth.extent.widthPx);
    std::uint32_t tileRow = 0;
    const auto close = [&] {
        opaque.closeInto(figures.opaque);
        subsurface.closeInto(figures.subsurface);
    };
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        const PixelTruth& pixel = truth.pixels[i];
        const float visibility = result[truth.indices[i]];
        if (!isCounted(pixel, visibility)) continue;
        const std::uint32_t x = truth.indices[i] % truth.extent.widthPx, y = truth.indices[i] / truth.extent.widthPx;
        if (y / kSubsetTilePx != tileRow) close();
        tileRow = y / kSubsetTilePx;
        add(pixel.subsurface ? figures.subsurface : figures.opaque, pixel, visibility, soft);
        if (pixel.subset && pixel.soft >= 0.0f) (pixel.subsurface ? subsurface : opaque).add(x, pixel, visibility);
    }
    close();
    return figures;
}

}  // namespace gnomon::renderer
