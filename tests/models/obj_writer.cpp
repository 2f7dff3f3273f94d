#include "tests/models/obj_writer.h"

#include <fmt/format.h>

#include <random>

namespace obscura {
namespace {

class Writer {
  public:
    explicit Writer(std::uint64_t seed) : random_(seed), objects_(chance(2) ? "o" : "g") {}

    WrittenObj run() {
        end_ = chance(3) ? "\r\n" : "\n";
        write_materials();
        line("mtllib a.mtl");
        if (chance(4)) line("f 1 2/2 3//3");  // points ahead
        for (int i = 0; i < 3; ++i) {
            line("v " + vector(3));
            line("vt " + vector(2));
            line("vn " + vector(3));
        }
        const int statements = 5 + below(60);
        for (int i = 0; i < statements; ++i)
            statement();
        return out_;
    }

  private:
    int below(int n) { return static_cast<int>(random_() % static_cast<std::uint64_t>(n)); }
    bool chance(int one_in) { return below(one_in) == 0; }

    void line(const std::string& text) {
        const char* indent = chance(10) ? " \t" : "";
        out_.obj += indent + text + (chance(8) ? "  " : "") + end_;
    }

    std::string digits(int count) {
        std::string text;
        for (int i = 0; i < count; ++i)
            text += static_cast<char>('0' + below(10));
        return text;
    }

    std::string number() {
        const char* sign = chance(2) ? "-" : chance(8) ? "+" : "";
        switch (below(8)) {
            case 0:
                return sign + digits(1 + below(4));
            case 1:
                return sign + digits(1) + ".";
            case 2:
                return sign + ("." + digits(1 + below(9)));
            case 3:
                return sign + digits(1 + below(3)) + "." + digits(120);
            case 4:
                return sign + ("0." + std::string(30, '0')) + digits(40);
            case 5:
                return fmt::format("{}{}.{}e{}", sign, digits(1), digits(7), below(70) - 40);
            case 6:
                return fmt::format("{}{}E+0{}", sign, digits(2), below(9));
            default:
                return sign + digits(2) + "." + digits(6);
        }
    }

    std::string vector(int n) {
        std::string text = number();
        for (int i = 1; i < n; ++i)
            text += (chance(6) ? "\t" : chance(6) ? "  " : " ") + number();
        return text;
    }

    /// One that exists, from the front or from the back.
    std::string index(int so_far) {
        const int i = 1 + below(so_far);
        return fmt::format("{}", chance(2) ? i : i - so_far - 1);
    }

    std::string corner(int kind) {
        const std::string v = index(positions_), t = index(uvs_), n = index(normals_);
        if (kind == 0) return v;
        if (kind == 1) return v + "/" + t;
        if (kind == 2) return v + "//" + n;
        return v + "/" + t + "/" + n;
    }

    void face() {
        const int corners = chance(100) ? 250 + below(50) : chance(3) ? 4 + below(9) : 3;
        const int kind = below(5);  // 4: another one for every corner
        std::string text = "f";
        for (int i = 0; i < corners; ++i)
            text += (chance(10) ? "\t" : " ") + corner(kind < 4 ? kind : below(4));
        line(text);
    }

    void statement() {
        switch (below(14)) {
            case 0:
            case 1:
            case 2:
                ++positions_;
                // A weight and a colour belong to no triangle.
                return line("v " + vector(chance(4) ? (chance(2) ? 4 : 6) : 3));
            case 3:
                ++uvs_;
                return line("vt " + vector(1 + below(3)));
            case 4:
                ++normals_;
                return line("vn " + vector(3));
            case 5:
                return line(chance(2) ? "# f 1 2 3 is no face here" : "");
            case 6:
                return line(fmt::format("usemtl m{}", below(4)));
            case 7:
                return line(fmt::format("{} part{}", objects_, below(5)));
            case 8:
                return line(chance(2) ? "s off" : fmt::format("s {}", below(9)));
            default:
                return face();
        }
    }

    void write_materials() {
        for (int m = 0; m < 4; ++m) {
            out_.mtl += fmt::format("newmtl m{}{}# a comment{}illum 2{}", m, end_, end_, end_);
            const auto colour = [&] { return fmt::format("0.{} 0.{} {}", digits(9), digits(3), below(2)); };
            if (!chance(4)) out_.mtl += "Kd " + (chance(4) ? "0 0 0" : colour()) + end_;
            if (chance(2)) out_.mtl += "Ks " + colour() + end_;
            if (chance(3)) out_.mtl += "Ke " + colour() + end_;
            if (chance(2)) out_.mtl += fmt::format("Ns {}.{}{}", below(1000), digits(4), end_);
            if (chance(3)) out_.mtl += "Pr 0." + digits(5) + end_;
            if (chance(3)) out_.mtl += "Pm 0." + digits(5) + end_;
            if (chance(2))
                out_.mtl += fmt::format("map_Kd {}wood {}.png{}", chance(2) ? "-blendu on " : "", m, end_);
        }
    }

    std::mt19937_64 random_;
    const char* objects_;
    const char* end_ = "\n";
    int positions_ = 3, uvs_ = 3, normals_ = 3;
    WrittenObj out_;
};

}  // namespace

WrittenObj write_obj(std::uint64_t seed) {
    return Writer(seed).run();
}

}  // namespace obscura
