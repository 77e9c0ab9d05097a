// SPDX-License-Identifier: MIT
#pragma once
/// @file Linear systems in files: a tangent and its right-hand side as a run met them, for benchmarks and bug reports.

#include <fibrant/assembly/visited_system.hpp>
#include <fibrant/core/parameters.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace fibrant::solver {

/// A copy of any system's terms with a right-hand side: a LinearSystem of its own.
///
/// Dense terms within the reach of a chain are kept as their sum, a lower block band a chain; others, and the point
/// terms, one by one. Products go term by term: right, not fast.
///
/// The file has "fibrant system 1\n", then counts as 64-bit integers and numbers as 64-bit floats, both with the least
/// byte first, in the order of `transfer` below.
class SavedSystem {
public:
    template <assembly::LinearSystem System>
    SavedSystem(const System& system, const Vector& right_hand_side)
        : layout_{system.layout()}, right_hand_side_{right_hand_side} {
        if (right_hand_side.size() != layout_.unknowns()) {
            core::refuse("SavedSystem.right_hand_side", std::to_string(right_hand_side.size()) + " numbers",
                         "as many as the system has unknowns");
        }
        for (const scene::Chain& chain : layout_.chains) bands_.push_back(Matrix::Zero(rows(chain), columns(chain)));
        struct Terms {
            SavedSystem& saved;
            assembly::VectorPlaces places;
            void point(const assembly::PointTerm& term) {
                saved.points_.push_back(
                    {{term.vectors.begin(), term.vectors.end()}, {term.weights.begin(), term.weights.end()}, term.stiffness});
            }
            void dense(const assembly::DenseTerm& term) {
                if (saved.add_to_band(places, term)) return;
                saved.dense_.push_back({{term.vectors.begin(), term.vectors.end()}, Matrix(term.stiffness)});
            }
        } terms{*this, assembly::VectorPlaces(layout_)};
        system.visit(terms);
        assembly::chain_bands_from_terms(*this, projected_);
    }

    /// @throws std::invalid_argument if the file cannot be read, or is not a whole system
    explicit SavedSystem(const std::filesystem::path& path) {
        std::ifstream file(path, std::ios::binary);
        if (!file) core::refuse("SavedSystem.path", "\"" + path.string() + "\"", "a file that can be read");
        std::string start(header.size(), ' ');
        file.read(start.data(), static_cast<std::streamsize>(start.size()));
        if (!file || start != header) core::refuse("SavedSystem.path", "\"" + path.string() + "\"", "a saved system");
        file.seekg(0, std::ios::end);
        Reader reader{file, path, static_cast<std::int64_t>(file.tellg())};
        file.seekg(static_cast<std::streamoff>(header.size()));
        transfer(reader, *this);
        if (!consistent()) reader.fail();
        assembly::chain_bands_from_terms(*this, projected_);
    }

    /// @throws std::runtime_error if the file cannot be written
    void write(const std::filesystem::path& path) const {
        std::ofstream file(path, std::ios::binary);
        file << header;
        Writer writer{file};
        transfer(writer, *this);
        file.close();
        if (!file) throw std::runtime_error("SavedSystem: \"" + path.string() + "\" cannot be written");
    }

    const Vector& right_hand_side() const noexcept { return right_hand_side_; }
    Index points() const noexcept { return core::count(points_); }

    const scene::DofLayout& layout() const noexcept { return layout_; }
    void apply(const Vector& x, Vector& y) const { assembly::apply_terms(*this, x, y); }
    void chain_band(Index chain, Matrix& blocks) const { blocks = projected_[core::at(chain)]; }
    void node_blocks(Index chain, Matrix& blocks) const {
        blocks = projected_[core::at(chain)].leftCols(3 * layout_.chains[core::at(chain)].vectors_per_node);
    }
    template <class Terms>
    void visit(Terms& terms) const {
        std::vector<Index> vectors;
        Matrix dense;
        for (std::size_t c = 0; c < bands_.size(); ++c) {
            const scene::Chain& chain = layout_.chains[c];
            const Index m = 3 * chain.vectors_per_node;
            for (Index a = 0; a < chain.nodes; ++a) {  // node a's row of the band, and its mirror
                const Index before = std::min(a, chain.reach);
                vectors.resize(core::at((before + 1) * chain.vectors_per_node));
                for (Index k = 0; k < core::count(vectors); ++k)
                    vectors[core::at(k)] = chain.first_vector + (a - before) * chain.vectors_per_node + k;
                dense.setZero((before + 1) * m, (before + 1) * m);
                for (Index d = 0; d <= before; ++d) {
                    const Matrix block = bands_[c].block(a * m, d * m, m, m);
                    dense.block(before * m, (before - d) * m, m, m) = block;
                    dense.block((before - d) * m, before * m, m, m) = block.transpose();
                }
                if (before > 0) dense.bottomRightCorner(m, m) = bands_[c].block(a * m, 0, m, m);
                terms.dense(assembly::DenseTerm{vectors, dense});
            }
        }
        for (const Dense& term : dense_) terms.dense(assembly::DenseTerm{term.vectors, term.stiffness});
        for (const Point& term : points_) terms.point(assembly::PointTerm{term.vectors, term.weights, term.stiffness});
    }

private:
    static constexpr std::string_view header = "fibrant system 1\n";
    struct Point {
        std::vector<Index> vectors;
        std::vector<double> weights;
        Mat3 stiffness = Mat3::Zero();
    };
    struct Dense {
        std::vector<Index> vectors;
        Matrix stiffness;
    };

    static Index rows(const scene::Chain& chain) noexcept { return 3 * chain.vectors_per_node * chain.nodes; }
    static Index columns(const scene::Chain& chain) noexcept { return 3 * chain.vectors_per_node * (chain.reach + 1); }

    bool add_to_band(const assembly::VectorPlaces& places, const assembly::DenseTerm& term) {
        const Index c = places.chain(term.vectors.front());
        const scene::Chain& chain = layout_.chains[core::at(c)];
        Index low = chain.nodes, high = 0;
        for (const Index v : term.vectors) {
            if (places.chain(v) != c) return false;
            low = std::min(low, places.number(v) / chain.vectors_per_node),
            high = std::max(high, places.number(v) / chain.vectors_per_node);
        }
        if (high - low > chain.reach) return false;
        for (std::size_t i = 0; i < term.vectors.size(); ++i)
            for (std::size_t j = 0; j < term.vectors.size(); ++j) {
                const Index k = places.number(term.vectors[i]), l = places.number(term.vectors[j]);
                const Index apart = k / chain.vectors_per_node - l / chain.vectors_per_node;
                if (apart < 0) continue;
                bands_[core::at(c)].block<3, 3>(3 * k, 3 * (apart * chain.vectors_per_node + l % chain.vectors_per_node)) +=
                    term.stiffness.block<3, 3>(3 * static_cast<Index>(i), 3 * static_cast<Index>(j));
            }
        return true;
    }

    // One description of the file serves writing and reading.
    struct Writer {
        std::ofstream& file;
        template <class Number>
        void numbers(const Number* from, Index n) {
            static_assert(sizeof(Number) == 8);
            for (Index k = 0; k < n; ++k) {
                std::uint64_t bits;
                std::memcpy(&bits, from + k, 8);
                std::array<char, 8> bytes;
                for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<char>((bits >> (8 * i)) & 0xff);
                file.write(bytes.data(), 8);
            }
        }
        template <class Container>
        void size(const Container& container, Index) {
            const std::int64_t n = core::count(container);
            numbers(&n, 1);
        }
    };
    struct Reader {
        std::ifstream& file;
        const std::filesystem::path& path;
        std::int64_t bytes_in_file;
        [[noreturn]] void fail() const { core::refuse("SavedSystem.path", "\"" + path.string() + "\"", "a whole saved system"); }
        template <class Number>
        void numbers(Number* to, Index n) {
            static_assert(sizeof(Number) == 8);
            for (Index k = 0; k < n; ++k) {
                std::array<char, 8> bytes{};
                file.read(bytes.data(), 8);
                std::uint64_t bits = 0;
                for (std::size_t i = 0; i < 8; ++i)
                    bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
                std::memcpy(to + k, &bits, 8);
            }
            if (!file) fail();
        }
        /// @param bytes  that an item of the container takes at least: a count that the file cannot hold is refused
        template <class Container>
        void size(Container& container, Index bytes) {
            std::int64_t n = 0;
            numbers(&n, 1);
            if (n < 0 || n > bytes_in_file / bytes) fail();
            container.resize(static_cast<std::size_t>(n));
        }
    };
    template <class File, class Self>
    static void transfer(File& file, Self& self) {
        auto& layout = self.layout_;
        file.size(layout.chains, 40);
        for (auto& chain : layout.chains)
            for (auto* number : {&chain.first_vector, &chain.nodes, &chain.vectors_per_node, &chain.reach, &chain.group})
                file.numbers(number, 1);
        file.size(layout.kind, 8);
        for (auto& kind : layout.kind) {
            std::int64_t number = static_cast<std::int64_t>(kind);
            file.numbers(&number, 1);
            if constexpr (!std::is_const_v<Self>) kind = static_cast<scene::VectorKind>(number);
        }
        file.size(layout.value, 24);
        for (auto& value : layout.value) file.numbers(value.data(), 3);
        file.size(layout.length, 8);
        file.numbers(layout.length.data(), core::count(layout.length));
        file.size(layout.held, 80);
        for (auto& held : layout.held) {
            file.numbers(&held.vector, 1);
            file.numbers(held.free.data(), 9);
        }
        if constexpr (!std::is_const_v<Self>) {
            if (!self.laid_out()) file.fail();
            for (const scene::Chain& chain : layout.chains) {
                if (rows(chain) * columns(chain) > file.bytes_in_file) file.fail();
                self.bands_.push_back(Matrix::Zero(rows(chain), columns(chain)));
            }
            self.right_hand_side_.resize(layout.unknowns());
        }
        for (auto& band : self.bands_) file.numbers(band.data(), band.size());
        file.size(self.dense_, 16);
        for (auto& term : self.dense_) {
            file.size(term.vectors, 8);
            file.numbers(term.vectors.data(), core::count(term.vectors));
            if constexpr (!std::is_const_v<Self>)
                term.stiffness.resize(3 * core::count(term.vectors), 3 * core::count(term.vectors));
            file.numbers(term.stiffness.data(), term.stiffness.size());
        }
        file.size(self.points_, 88);
        for (auto& term : self.points_) {
            file.size(term.vectors, 8);
            file.numbers(term.vectors.data(), core::count(term.vectors));
            if constexpr (!std::is_const_v<Self>) term.weights.resize(term.vectors.size());
            file.numbers(term.weights.data(), core::count(term.weights));
            file.numbers(term.stiffness.data(), 9);
        }
        file.numbers(self.right_hand_side_.data(), self.right_hand_side_.size());
    }
    /// Do the parts of the layout fit one another?
    bool laid_out() const {
        Index next = 0;
        for (const scene::Chain& chain : layout_.chains) {
            const bool sane = chain.first_vector == next && chain.nodes > 0 && chain.vectors_per_node > 0 && chain.reach >= 0 &&
                              chain.nodes <= layout_.vectors() && chain.vectors_per_node <= layout_.vectors() &&
                              chain.reach <= chain.nodes;
            if (!sane) return false;
            next += chain.nodes * chain.vectors_per_node;
        }
        if (next != layout_.vectors() || layout_.value.size() != layout_.kind.size() ||
            layout_.length.size() != layout_.kind.size())
            return false;
        return std::all_of(layout_.held.begin(), layout_.held.end(),
                           [&](const scene::HeldVector& h) { return h.vector >= 0 && h.vector < next; });
    }
    /// Do all terms name vectors that there are?
    bool consistent() const {
        const auto known = [&](const auto& term) {
            return !term.vectors.empty() && std::all_of(term.vectors.begin(), term.vectors.end(),
                                                        [&](Index v) { return v >= 0 && v < layout_.vectors(); });
        };
        return std::all_of(dense_.begin(), dense_.end(), known) && std::all_of(points_.begin(), points_.end(), known);
    }

    scene::DofLayout layout_;
    std::vector<Matrix> bands_;      // sums of dense terms, not projected
    std::vector<Matrix> projected_;  // with contact elements, as chain_band gives them
    std::vector<Dense> dense_;
    std::vector<Point> points_;
    Vector right_hand_side_;
};
static_assert(assembly::LinearSystem<SavedSystem>);

/// Writes a system and its right-hand side to a file, which SavedSystem reads.
template <assembly::LinearSystem System>
void write_system(const std::filesystem::path& path, const System& system, const Vector& right_hand_side) {
    if (!system.layout().ties.empty())
        core::refuse("write_system.ties", std::to_string(system.layout().ties.size()), "none: a file has no place for them");
    SavedSystem(system, right_hand_side).write(path);
}

}  // namespace fibrant::solver
