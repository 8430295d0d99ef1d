// House rules over the text of the sources.
//
// Problem: a layer that reaches around another compiles for years and cannot be taken apart later.
// Here: every #include line is resolved to a file of the project or to a name outside it, and compared with a table of
// rooms. The plain way, a linker boundary per room, would not see headers and shaders.
// Limits: lines inside #if 0 or block comments count as well; computed includes are refused.
#include "unit/house/rules.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>

namespace gnomon::house {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRooms[] = {"include",  "src", "visualize", "inspect", "reference", "scene", "truth", "picture",
                                  "renderer", "app", "examples",  "tests",   "bench",     "docs",  "cmake", "scripts"};
constexpr std::string_view kTextEndings[] = {".h",  ".cpp",   ".glsl", ".comp", ".vert", ".frag",
                                             ".md", ".cmake", ".txt",  ".sh",   ".json"};

// What a room may see: rooms of the project, and names outside it.
struct Allowed {
    std::vector<std::string> rooms;
    bool vulkan = true;
    bool thirdParty = false;
};

const std::map<std::string, Allowed>& cppRules() {
    static const std::map<std::string, Allowed> rules = {
        {"include", {{"include"}}},
        {"gpu_interface", {{"gpu_interface"}, false}},
        {"src", {{"src", "gpu_interface", "include"}}},
        {"reference", {{"reference", "gpu_interface"}, false}},
        {"visualize", {{"visualize", "src", "gpu_interface", "include"}}},
        {"scene", {{"scene", "include"}, false, true}},
        {"truth", {{"truth", "scene", "include"}, false, true}},
        {"picture", {{"picture"}, false, true}},
        {"renderer", {{"renderer", "scene", "picture", "src", "gpu_interface", "include"}, true, true}},
        {"app",
         {{"app", "renderer", "scene", "truth", "picture", "visualize", "reference", "src", "gpu_interface", "include"},
          true,
          true}},
        {"app/view",
         {{"app/view", "app", "renderer", "scene", "truth", "picture", "visualize", "reference", "src", "gpu_interface",
           "include"},
          true,
          true}},
        {"examples", {{"examples", "include"}}},
    };
    return rules;
}

const std::map<std::string, Allowed>& shaderRules() {
    static const std::map<std::string, Allowed> rules = {
        {"gpu_interface", {{"gpu_interface"}}},
        {"src", {{"src", "gpu_interface"}}},
        {"visualize", {{"visualize", "src", "gpu_interface"}}},
        {"renderer", {{"renderer", "src", "gpu_interface"}}},
        {"app", {{"app", "renderer", "visualize", "src", "gpu_interface"}}},
        {"app/view", {{"app/view", "app", "renderer", "visualize", "src", "gpu_interface"}}},
        {"examples", {{"examples", "src", "gpu_interface"}}},
    };
    return rules;
}

// C++20's headers, without the <name.h> forms of C.
bool isStandard(const std::string& name) {
    static const std::set<std::string> names = {"algorithm",
                                                "any",
                                                "array",
                                                "atomic",
                                                "barrier",
                                                "bit",
                                                "bitset",
                                                "cassert",
                                                "cctype",
                                                "cerrno",
                                                "cfenv",
                                                "cfloat",
                                                "charconv",
                                                "chrono",
                                                "cinttypes",
                                                "climits",
                                                "clocale",
                                                "cmath",
                                                "codecvt",
                                                "compare",
                                                "complex",
                                                "concepts",
                                                "condition_variable",
                                                "coroutine",
                                                "csetjmp",
                                                "csignal",
                                                "cstdarg",
                                                "cstddef",
                                                "cstdint",
                                                "cstdio",
                                                "cstdlib",
                                                "cstring",
                                                "ctime",
                                                "cuchar",
                                                "cwchar",
                                                "cwctype",
                                                "deque",
                                                "exception",
                                                "execution",
                                                "filesystem",
                                                "format",
                                                "forward_list",
                                                "fstream",
                                                "functional",
                                                "future",
                                                "initializer_list",
                                                "iomanip",
                                                "ios",
                                                "iosfwd",
                                                "iostream",
                                                "istream",
                                                "iterator",
                                                "latch",
                                                "limits",
                                                "list",
                                                "locale",
                                                "map",
                                                "memory",
                                                "memory_resource",
                                                "mutex",
                                                "new",
                                                "numbers",
                                                "numeric",
                                                "optional",
                                                "ostream",
                                                "queue",
                                                "random",
                                                "ranges",
                                                "ratio",
                                                "regex",
                                                "scoped_allocator",
                                                "semaphore",
                                                "set",
                                                "shared_mutex",
                                                "source_location",
                                                "span",
                                                "sstream",
                                                "stack",
                                                "stdexcept",
                                                "stop_token",
                                                "streambuf",
                                                "string",
                                                "string_view",
                                                "strstream",
                                                "syncstream",
                                                "system_error",
                                                "thread",
                                                "tuple",
                                                "type_traits",
                                                "typeindex",
                                                "typeinfo",
                                                "unordered_map",
                                                "unordered_set",
                                                "utility",
                                                "valarray",
                                                "variant",
                                                "vector",
                                                "version"};
    return names.contains(name);
}

bool isGui(const std::string& name) {
    static const std::regex pattern(R"((^|/)(imgui|SDL|sdl|glfw|GLFW|glad|X11|xcb|wayland|Qt|gtk|windows\.h))");
    return std::regex_search(name, pattern);
}

bool endsWith(std::string_view text, std::string_view end) {
    return text.ends_with(end);
}

// The project's file that an include names, or nothing. Search order: beside the includer, then the include paths.
std::string resolve(const std::string& includer, const Include& include, const std::set<std::string>& paths) {
    std::vector<fs::path> candidates;
    if (include.form == Include::Form::Quoted) candidates.push_back(fs::path(includer).parent_path() / include.name);
    for (const char* directory : {"include", "src", "", "tests"})
        candidates.push_back(fs::path(directory) / include.name);
    for (const fs::path& candidate : candidates) {
        const std::string normal = candidate.lexically_normal().generic_string();
        if (paths.contains(normal)) return normal;
    }
    return {};
}

bool isGeneratedShader(const Include& include) {
    return include.form == Include::Form::Quoted && endsWith(include.name, ".spv.h");
}

// Why `room` may not include this, or nothing.
// What the library is asked and answers in phase 1, in plain data: all that the oracle may see of its public face.
constexpr const char* kDescriptions[] = {"include/gnomon/scene.h", "include/gnomon/settings.h",
                                         "include/gnomon/prepare.h", "include/gnomon/result.h"};

std::string refusal(const std::string& room, const Allowed& allowed, const Include& include, const std::string& target,
                    bool shader) {
    if (include.form == Include::Form::Macro) return "a computed include cannot be checked";
    if (shader && room == "src" && include.name == "gnomon_host_provider.glsl") return "";  // the host's own file
    if (!target.empty()) {
        const std::string other = roomOf(target);
        const bool open = std::ranges::find(allowed.rooms, other) != allowed.rooms.end() ||
                          (room == "reference" && std::ranges::find(kDescriptions, target) != std::end(kDescriptions));
        return open ? "" : "'" + room + "' must not see '" + (other.empty() ? target : other) + "'";
    }
    if (shader) return "no such file in the project";
    if (isGui(include.name) && room != "app/view") return "GUI code lives in app/view alone";
    if (isGeneratedShader(include)) {
        return room == "include" || room == "reference" ? "'" + room + "' must not see shaders" : "";
    }
    if (isStandard(include.name) && include.form == Include::Form::Angled) return "";
    if (include.name.starts_with("vulkan/")) return allowed.vulkan ? "" : "'" + room + "' must not see Vulkan";
    return allowed.thirdParty ? "" : "'" + room + "' may see the C++ standard library, Vulkan and the project alone";
}

std::string at(const TextFile& file, std::size_t line) {
    return file.path + ":" + std::to_string(line) + ": ";
}

std::size_t lineCount(std::string_view text) {
    const auto ends = static_cast<std::size_t>(std::ranges::count(text, '\n'));
    return ends + (!text.empty() && text.back() != '\n' ? 1 : 0);
}

std::size_t lineOf(std::string_view text, std::size_t position) {
    return 1 + static_cast<std::size_t>(std::ranges::count(text.substr(0, position), '\n'));
}

bool isText(const fs::path& path) {
    const std::string ending = path.extension().string();
    return std::ranges::find(kTextEndings, ending) != std::end(kTextEndings);
}

TextFile read(const fs::path& root, const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {path.lexically_relative(root).generic_string(), std::string(std::istreambuf_iterator<char>(in), {})};
}

}  // namespace

std::vector<TextFile> readProject(const fs::path& root) {
    std::vector<TextFile> files;
    for (const auto& entry : fs::directory_iterator(root)) {
        if (entry.is_regular_file() && isText(entry.path())) files.push_back(read(root, entry.path()));
    }
    for (const char* room : kRooms) {
        if (!fs::exists(root / room)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
            if (entry.is_regular_file() && isText(entry.path())) files.push_back(read(root, entry.path()));
        }
    }
    std::ranges::sort(files, {}, &TextFile::path);
    return files;
}

std::vector<Include> includesOf(std::string_view text) {
    static const std::regex pattern(R"(^[ \t]*#[ \t]*include[ \t]*("([^"]*)\"|<([^>]*)>|([A-Za-z_]\w*)))");
    std::vector<Include> out;
    std::size_t number = 0;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string line(text.substr(begin, end - begin));
        begin = end + 1;
        ++number;
        std::smatch match;
        if (!std::regex_search(line, match, pattern)) continue;
        if (match[2].matched) out.push_back({number, match[2], Include::Form::Quoted});
        if (match[3].matched) out.push_back({number, match[3], Include::Form::Angled});
        if (match[4].matched) out.push_back({number, match[4], Include::Form::Macro});
    }
    return out;
}

std::string roomOf(std::string_view path) {
    for (const std::string_view inner : {"src/gpu_interface/", "app/view/"}) {
        if (path.starts_with(inner)) return inner == "app/view/" ? "app/view" : "gpu_interface";
    }
    const std::size_t slash = path.find('/');
    return slash == std::string_view::npos ? std::string() : std::string(path.substr(0, slash));
}

bool isCpp(std::string_view path) {
    return endsWith(path, ".h") || endsWith(path, ".cpp");
}
bool isShader(std::string_view path) {
    return endsWith(path, ".glsl") || endsWith(path, ".comp") || endsWith(path, ".vert") || endsWith(path, ".frag");
}

Violations checkIncludes(const TextFile& file, const std::set<std::string>& paths) {
    const std::string room = roomOf(file.path);
    const bool shader = isShader(file.path);
    const auto& rules = shader ? shaderRules() : cppRules();
    const auto rule = rules.find(room);
    Violations out;
    for (const Include& include : includesOf(file.text)) {
        if (rule == rules.end()) {
            if (isGui(include.name)) out.push_back(at(file, include.line) + "GUI code lives in app/view alone.");
            continue;
        }
        const std::string why = refusal(room, rule->second, include, resolve(file.path, include, paths), shader);
        if (!why.empty()) out.push_back(at(file, include.line) + "includes '" + include.name + "': " + why + ".");
    }
    return out;
}

Violations checkSize(const TextFile& file) {
    const std::size_t most = isCpp(file.path) ? kMaxCppLines : isShader(file.path) ? kMaxShaderLines : 0;
    const std::size_t lines = lineCount(file.text);
    if (most == 0 || lines < most) return {};
    return {at(file, lines) + "has " + std::to_string(lines) + " lines; fewer than " + std::to_string(most) +
            " are allowed."};
}

Violations checkText(const TextFile& file) {
    // Split, so that this file passes its own check.
    static const std::string words[] = {std::string("keep in") + " sync", std::string("/wo") + "rk/",
                                        std::string("/ho") + "me/",       std::string("/ro") + "ot/",
                                        std::string(".inter") + "nal",    std::string("artif") + "actory",
                                        std::string("index") + "-url",    std::string("jf") + "rog"};
    Violations out;
    std::string lowered = file.text;
    std::ranges::transform(lowered, lowered.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    for (const std::string& word : words) {
        const std::size_t found = lowered.find(word);
        if (found != std::string::npos) out.push_back(at(file, lineOf(file.text, found)) + "says '" + word + "'.");
    }
    const std::size_t tab = file.text.find('\t');
    if ((isCpp(file.path) || isShader(file.path)) && tab != std::string::npos) {
        out.push_back(at(file, lineOf(file.text, tab)) + "has a tab.");
    }
    return out;
}

Violations checkProject(const std::vector<TextFile>& files) {
    std::set<std::string> paths;
    for (const TextFile& file : files) paths.insert(file.path);
    Violations out;
    for (const TextFile& file : files) {
        Violations found = checkSize(file);
        std::ranges::move(checkText(file), std::back_inserter(found));
        if (isCpp(file.path) || isShader(file.path))
            std::ranges::move(checkIncludes(file, paths), std::back_inserter(found));
        std::ranges::move(found, std::back_inserter(out));
    }
    return out;
}

}  // namespace gnomon::house
