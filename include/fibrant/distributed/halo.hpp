// SPDX-License-Identifier: MIT
#pragma once
/// @file Vectors whose values ranks tell each other.

#include <fibrant/distributed/exchange.hpp>
#include <fibrant/distributed/routes.hpp>
#include <fibrant/distributed/subdomains.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace fibrant::distributed {

/// Vectors whose values go from the rank that owns them to the ranks that read them.
class Halo {
public:
    /// A vector and the rank that reads it.
    using Reader = std::pair<int, Index>;

    /// @param readers  of all vectors, on all ranks the same; those of owners are left out
    Halo(int rank, const BlockRuns& runs, const std::vector<int>& owner, std::vector<Reader> readers) {
        std::sort(readers.begin(), readers.end());
        readers.erase(std::unique(readers.begin(), readers.end()), readers.end());
        std::vector<std::pair<int, Index>> out, in;  // partner, vector
        for (const auto& [reader, vector] : readers) {
            const int from = runs.rank_of(owner[core::at(vector)]);
            if (from == reader) continue;
            if (from == rank) out.emplace_back(reader, vector);
            if (reader == rank) in.emplace_back(from, vector);
        }
        std::sort(out.begin(), out.end()), std::sort(in.begin(), in.end());
        for (const auto& list : {out, in})
            for (const auto& [partner, vector] : list) partners_.ranks.push_back(partner);
        std::sort(partners_.ranks.begin(), partners_.ranks.end());
        partners_.ranks.erase(std::unique(partners_.ranks.begin(), partners_.ranks.end()), partners_.ranks.end());
        partners_.first_sent = firsts(out, sent_), partners_.first_received = firsts(in, received_);
        out_.resize(3 * sent_.size()), in_.resize(3 * received_.size());
    }
    Halo() = default;

    /// Sets the values of vectors that others own and this rank reads.
    template <Exchange E>
    void refresh(const E& exchange, Vector& x, Traffic& traffic) {
        if (exchange.ranks() == 1) return;
        for (std::size_t k = 0; k < sent_.size(); ++k)
            for (std::size_t i = 0; i < 3; ++i) out_[3 * k + i] = x[3 * sent_[k] + static_cast<Index>(i)];
        exchange.swap(partners_, out_, in_);
        for (std::size_t k = 0; k < received_.size(); ++k)
            for (std::size_t i = 0; i < 3; ++i) x[3 * received_[k] + static_cast<Index>(i)] = in_[3 * k + i];
        traffic.messages += core::count(partners_.ranks), traffic.bytes += 8 * core::count(out_);
    }
    /// Vectors of others that this rank reads.
    const std::vector<Index>& received() const noexcept { return received_; }

private:
    std::vector<Index> firsts(const std::vector<std::pair<int, Index>>& list, std::vector<Index>& vectors) const {
        std::vector<Index> first{0};
        for (const int partner : partners_.ranks) {
            for (const auto& [to, vector] : list)
                if (to == partner) vectors.push_back(vector);
            first.push_back(3 * core::count(vectors));
        }
        return first;
    }
    Partners partners_;
    std::vector<Index> sent_, received_;
    std::vector<double> out_, in_;
};

/// Who reads vectors because of bands, whatever touches.
inline std::vector<Halo::Reader> band_readers(const scene::DofLayout& layout, const Subdomains& cut, const BlockRuns& runs) {
    std::vector<Halo::Reader> readers;
    const auto rank_of = [&](Index v) { return runs.rank_of(cut.owner()[core::at(v)]); };
    for (const scene::Chain& chain : layout.chains)
        for (Index a = 0; a < chain.nodes; ++a)
            for (Index b = std::max<Index>(0, a - chain.reach); b <= std::min(chain.nodes - 1, a + chain.reach); ++b) {
                const Index own = chain.first_vector + a * chain.vectors_per_node;
                const Index other = chain.first_vector + b * chain.vectors_per_node;
                const int reader = rank_of(own);
                if (rank_of(other) == reader) continue;
                for (Index v = other; v < other + chain.vectors_per_node; ++v) readers.emplace_back(reader, v);
            }
    std::sort(readers.begin(), readers.end());
    readers.erase(std::unique(readers.begin(), readers.end()), readers.end());
    return readers;
}

/// Makes x whole on all ranks.
template <Exchange E>
void gather_owned(const E& exchange, const Subdomains& cut, const BlockRuns& runs, Vector& x, Traffic& traffic) {
    if (exchange.ranks() == 1) return;
    std::vector<Index> counts;
    std::vector<double> own, all(core::at(x.size()));
    for (int r = 0; r < exchange.ranks(); ++r) {
        Index sum = 0;
        for (Index part = runs.first(r); part < runs.first(r + 1); ++part) sum += 3 * core::count(cut.owned()[core::at(part)]);
        counts.push_back(sum);
    }
    for (Index part = runs.first(exchange.rank()); part < runs.first(exchange.rank() + 1); ++part)
        for (const Index v : cut.owned()[core::at(part)]) own.insert(own.end(), x.data() + 3 * v, x.data() + 3 * v + 3);
    traffic.gatherings += 1, traffic.gathered_bytes += 8 * core::count(own);
    exchange.gather(own, counts, all);
    const double* from = all.data();
    for (const std::vector<Index>& part : cut.owned())
        for (const Index v : part) std::copy_n(from, 3, x.data() + 3 * v), from += 3;
}

}  // namespace fibrant::distributed
