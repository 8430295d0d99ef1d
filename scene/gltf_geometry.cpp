#include "scene/gltf_geometry.h"

#include <algorithm>
#include <map>
#include <memory>

#include "scene/gltf_accessor.h"
#include "scene/gltf_draco.h"

namespace gnomon::renderer::gltf {
namespace {

template <int N>
bool finite(const glm::vec<N, float>& v) {
    for (int c = 0; c < N; ++c)
        if (!std::isfinite(v[c])) return false;
    return true;
}

// Beyond this, squared lengths and transformed positions overflow a float.
constexpr float kMaxCoordinate = 1.0e15f;

class Reader {
public:
    Reader(Document& document, const tinygltf::Primitive& source, const std::string& user)
        : document_(document), source_(source), user_(user) {
        if (const auto* draco = extension(source.extensions, "KHR_draco_mesh_compression"))
            draco_ = std::make_unique<DracoPrimitive>(document, *draco, user);
    }

    bool has(const std::string& name) const { return source_.attributes.contains(name); }
    const DracoPrimitive* draco() const { return draco_.get(); }

    // Empty when the attribute is absent.
    template <int N>
    std::vector<glm::vec<N, float>> read(const std::string& name, std::size_t leastComponents, float fill = 0.0f) {
        if (!has(name)) return {};
        const std::string what = fmt::format("{} of {}", name, user_);
        std::vector<glm::vec<N, float>> out;
        if (draco_ && draco_->has(name)) {
            const std::vector<float> flat = draco_->read(name, N, fill, user_);
            out.resize(flat.size() / N);
            for (std::size_t i = 0; i < out.size(); ++i)
                for (int c = 0; c < N; ++c) out[i][c] = flat[i * N + static_cast<std::size_t>(c)];
        } else {
            out =
                readVectors<N>(document_, source_.attributes.at(name), leastComponents, glm::vec<N, float>(fill), what);
        }
        if (vertexCount_ == 0) vertexCount_ = out.size();
        if (out.size() != vertexCount_) refuse("{} has {} elements for {} vertices", what, out.size(), vertexCount_);
        return out;
    }

    // Offsets of one attribute of a morph target; empty when it is absent.
    std::vector<glm::vec3> readTarget(const std::map<std::string, int>& target, const char* name) {
        const auto found = target.find(name);
        if (found == target.end()) return {};
        const std::string what = fmt::format("the morph target's {} of {}", name, user_);
        document_.spendMotionNumbers(3 * vertexCount_);
        std::vector<glm::vec3> out = readVectors<3>(document_, found->second, 3, glm::vec3(0.0f), what);
        if (out.size() != vertexCount_) refuse("{} has {} elements for {} vertices", what, out.size(), vertexCount_);
        for (const glm::vec3& v : out)
            if (!(glm::length(v) < kMaxCoordinate))
                refuse("{} has a number that is not finite or beyond {:g}", what, kMaxCoordinate);
        return out;
    }

    std::vector<std::uint32_t> indices() {
        std::vector<std::uint32_t> out;
        if (draco_) {
            out = draco_->indices();
        } else if (source_.indices >= 0) {
            out = readIndices(document_, source_.indices, "the indices of " + user_);
        } else {
            out.resize(vertexCount_);
            for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<std::uint32_t>(i);
        }
        for (std::uint32_t index : out)
            if (index >= vertexCount_) refuse("{} has the index {} for {} vertices", user_, index, vertexCount_);
        return out;
    }

private:
    Document& document_;
    const tinygltf::Primitive& source_;
    const std::string& user_;
    std::unique_ptr<DracoPrimitive> draco_;
    std::size_t vertexCount_ = 0;
};

// Strips and fans into lists; the first vertex of each triangle follows the glTF specification, section 3.7.2.1.
std::vector<std::uint32_t> triangulated(std::vector<std::uint32_t> in, int mode) {
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        in.resize(in.size() / 3 * 3);
        return in;
    }
    std::vector<std::uint32_t> out;
    if (in.size() < 3) return out;
    out.reserve((in.size() - 2) * 3);
    for (std::size_t i = 0; i + 2 < in.size(); ++i) {
        const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
        const std::uint32_t a = fan ? in[i + 1] : in[i];
        const std::uint32_t b = fan ? in[i + 2] : in[i + 1 + i % 2];
        const std::uint32_t c = fan ? in[0] : in[i + 2 - i % 2];
        if (a == b || b == c || a == c) continue;  // strips are stitched with such triangles
        out.insert(out.end(), {a, b, c});
    }
    return out;
}

// Unit normals; those that have no direction take the area-weighted mean of the triangles around them.
std::size_t repairNormals(Primitive& primitive) {
    std::vector<bool> broken(primitive.normals.size(), false);
    std::size_t count = 0;
    for (std::size_t i = 0; i < broken.size(); ++i) {
        glm::vec3& n = primitive.normals[i];
        const float length = finite<3>(n) ? glm::length(n) : 0.0f;
        broken[i] = !(length > 1.0e-6f) || !std::isfinite(length);
        if (broken[i]) ++count;
        n = broken[i] ? glm::vec3(0.0f) : n / length;
    }
    if (count == 0) return 0;
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
        const std::uint32_t* corner = primitive.indices.data() + i;
        const glm::vec3 a = primitive.positions[corner[0]];
        const glm::vec3 n = glm::cross(primitive.positions[corner[1]] - a, primitive.positions[corner[2]] - a);
        for (int c = 0; c < 3; ++c)
            if (broken[corner[c]]) primitive.normals[corner[c]] += n;
    }
    for (std::size_t i = 0; i < broken.size(); ++i) {
        if (!broken[i]) continue;
        const float length = glm::length(primitive.normals[i]);
        const bool usable = length > 0.0f && std::isfinite(length);
        primitive.normals[i] = usable ? primitive.normals[i] / length : glm::vec3(0.0f, 1.0f, 0.0f);
    }
    return count;
}

void repairAttributes(Document& document, Primitive& primitive, const std::string& user) {
    if (const std::size_t count = repairNormals(primitive))
        document.note(fmt::format("{} has {} normals without a direction; they were computed anew.", user, count));
    const bool badTangent = std::any_of(primitive.tangents.begin(), primitive.tangents.end(), [](const glm::vec4& t) {
        return !finite<4>(t) || !(glm::dot(glm::vec3(t), glm::vec3(t)) > 1.0e-12f) || t.w == 0.0f;
    });
    if (badTangent) {
        document.note(fmt::format("{} has tangents without a direction; they are derived instead.", user));
        primitive.tangents.clear();
    }
    for (glm::vec4& t : primitive.tangents) t = glm::vec4(glm::normalize(glm::vec3(t)), t.w < 0.0f ? -1.0f : 1.0f);
    bool badNumber = false;
    for (auto& texcoords : primitive.texcoords)
        for (glm::vec2& uv : texcoords)
            if (!finite<2>(uv)) {
                uv = glm::vec2(0.0f);
                badNumber = true;
            }
    for (glm::vec4& colour : primitive.colours) {
        if (!finite<4>(colour)) {
            colour = glm::vec4(1.0f);
            badNumber = true;
        }
        colour = glm::max(colour, glm::vec4(0.0f));
    }
    if (badNumber)
        document.note(
            fmt::format("{} has texture coordinates or colours that are not finite; they were replaced.", user));
}

template <class T>
void keep(std::vector<T>& attribute, const std::vector<std::uint32_t>& kept) {
    if (attribute.empty()) return;
    std::vector<T> out(kept.size());
    for (std::size_t i = 0; i < kept.size(); ++i) out[i] = attribute[kept[i]];
    attribute = std::move(out);
}

// Many files share one vertex buffer between all primitives; each keeps only the vertices that it uses.
void dropUnusedVertices(Primitive& primitive) {
    std::vector<std::uint32_t> newIndex(primitive.positions.size(), kNone), kept;
    for (std::uint32_t index : primitive.indices)
        if (newIndex[index] == kNone) newIndex[index] = 0;
    for (std::size_t i = 0; i < newIndex.size(); ++i) {
        if (newIndex[i] == kNone) continue;
        newIndex[i] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(static_cast<std::uint32_t>(i));
    }
    if (kept.size() == primitive.positions.size()) return;
    for (std::uint32_t& index : primitive.indices) index = newIndex[index];
    keep(primitive.positions, kept);
    keep(primitive.normals, kept);
    keep(primitive.tangents, kept);
    keep(primitive.texcoords[0], kept);
    keep(primitive.texcoords[1], kept);
    keep(primitive.colours, kept);
    keep(primitive.joints, kept);
    keep(primitive.weights, kept);
    for (MorphTarget& target : primitive.targets) {
        keep(target.positions, kept);
        keep(target.normals, kept);
        keep(target.tangents, kept);
    }
}

void readSkin(Reader& reader, Primitive& primitive, Document& document, const std::string& user) {
    if (!reader.has("JOINTS_0")) return;
    if (!reader.has("WEIGHTS_0")) refuse("{} has JOINTS_0 without WEIGHTS_0", user);
    if (reader.has("JOINTS_1"))
        document.note(fmt::format("{} has more than four joints per vertex; four are used.", user));
    const std::vector<glm::vec4> joints = reader.read<4>("JOINTS_0", 4);
    primitive.weights = reader.read<4>("WEIGHTS_0", 4);
    primitive.joints.resize(joints.size());
    for (std::size_t i = 0; i < joints.size(); ++i) {
        glm::vec4& weight = primitive.weights[i];
        for (int c = 0; c < 4; ++c) {
            if (!(joints[i][c] >= 0.0f && joints[i][c] <= 65535.0f))
                refuse("{} has a joint index that is no index", user);
            if (!(weight[c] >= 0.0f && weight[c] <= 1.0e6f)) refuse("{} has a joint weight of {}", user, weight[c]);
            // Where it has no weight a joint may be any number; nobody shall look it up.
            primitive.joints[i][c] = static_cast<std::uint16_t>(weight[c] > 0.0f || c == 0 ? joints[i][c] : 0.0f);
        }
        const float sum = weight.x + weight.y + weight.z + weight.w;
        weight = sum > 0.0f ? weight / sum : glm::vec4(1.0f, 0.0f, 0.0f, 0.0f);
        if (weight.x == 0.0f) primitive.joints[i].x = 0;
    }
}

void readTargets(Reader& reader, const tinygltf::Primitive& source, Primitive& primitive) {
    for (const auto& from : source.targets) {
        MorphTarget target;
        target.positions = reader.readTarget(from, "POSITION");
        target.normals = reader.readTarget(from, "NORMAL");
        target.tangents = reader.readTarget(from, "TANGENT");
        primitive.targets.push_back(std::move(target));
    }
}

void computeBounds(Primitive& primitive) {
    for (std::uint32_t index : primitive.indices) primitive.bounds.add(primitive.positions[index]);
}

}  // namespace

std::optional<Primitive> loadPrimitive(Document& document, const tinygltf::Primitive& source, const std::string& user) {
    if (source.mode < 0 || source.mode > TINYGLTF_MODE_TRIANGLE_FAN)
        refuse("{} has the unknown mode {}", user, source.mode);
    if (source.mode < TINYGLTF_MODE_TRIANGLES) {
        document.note(fmt::format("{} holds points or lines and is not drawn.", user));
        return std::nullopt;
    }
    Reader reader(document, source, user);
    if (!reader.has("POSITION")) refuse("{} has no POSITION", user);
    Primitive primitive;
    primitive.positions = reader.read<3>("POSITION", 3);
    for (const glm::vec3& p : primitive.positions)
        if (!(glm::length(p) < kMaxCoordinate))
            refuse("{} has a position that is not finite or beyond {:g}", user, kMaxCoordinate);
    const std::vector<std::uint32_t> indices = reader.indices();
    const int mode =
        reader.draco() ? TINYGLTF_MODE_TRIANGLES : source.mode;  // Draco holds lists, whatever the mode says
    if (mode == TINYGLTF_MODE_TRIANGLES && indices.size() % 3 != 0)
        document.note(fmt::format("{} ends with an incomplete triangle, which is left out.", user));
    primitive.indices = triangulated(indices, mode);
    if (primitive.indices.empty()) {
        document.note(fmt::format("{} has no triangle and is not drawn.", user));
        return std::nullopt;
    }
    primitive.normals = reader.read<3>("NORMAL", 3);
    primitive.tangents = reader.read<4>("TANGENT", 4);
    primitive.texcoords[0] = reader.read<2>("TEXCOORD_0", 2);
    primitive.texcoords[1] = reader.read<2>("TEXCOORD_1", 2);
    primitive.colours = reader.read<4>("COLOR_0", 3, 1.0f);
    if (primitive.normals.empty()) primitive.tangents.clear();
    readSkin(reader, primitive, document, user);
    readTargets(reader, source, primitive);
    dropUnusedVertices(primitive);
    repairAttributes(document, primitive, user);
    computeBounds(primitive);
    return primitive;
}

}  // namespace gnomon::renderer::gltf
