// SPDX-License-Identifier: MIT
#pragma once
/// @file What ranks tell each other of vectors: values of owners to those who read them, and contributions back to owners.

#include <fibrant/distributed/exchange.hpp>
#include <fibrant/distributed/pair_terms.hpp>
#include <fibrant/distributed/piece_system.hpp>
#include <fibrant/distributed/routes.hpp>
#include <fibrant/distributed/subdomains.hpp>

#include <algorithm>
#include <tuple>
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

/// Sums of what the pieces of several parts have for a vector, on the rank that owns it and in the order of the parts.
class SumToOwners {
public:
    SumToOwners() = default;
    SumToOwners(int rank, const scene::DofLayout& layout, const BlockRuns& runs, const Subdomains& cut) {
        struct Sent {
            int from, to;
            Index slot, vector;  // slot within the pieces of the sender
        };
        std::vector<Sent> sent;
        std::vector<Index> slots(runs.counts().size(), 0);
        for (const Piece& piece : cut.pieces()) {
            const int own = runs.rank_of(piece.part);
            const scene::Chain& chain = layout.chains[core::at(piece.chain)];
            const Index first = chain.first_vector + piece.first_node * chain.vectors_per_node;
            for (Index v = first; v < first + piece.nodes * chain.vectors_per_node; ++v) {
                const Index slot = slots[core::at(own)]++;
                const int to = runs.rank_of(cut.owner()[core::at(v)]);
                if (to == rank || own == rank) sent.push_back({own, to, slot, v});
            }
        }
        for (const Sent& one : sent)
            if (one.from != one.to) partners_.ranks.push_back(one.from == rank ? one.to : one.from);
        std::sort(partners_.ranks.begin(), partners_.ranks.end());
        partners_.ranks.erase(std::unique(partners_.ranks.begin(), partners_.ranks.end()), partners_.ranks.end());
        std::vector<std::vector<Index>> out(partners_.ranks.size());
        std::vector<Index> in(partners_.ranks.size() + 1, 0);
        const auto place = [&](int partner) {
            return static_cast<std::size_t>(std::lower_bound(partners_.ranks.begin(), partners_.ranks.end(), partner) -
                                            partners_.ranks.begin());
        };
        for (const Sent& one : sent) {
            if (one.from == rank && one.to != rank) out[place(one.to)].push_back(one.slot);
            if (one.from != rank) ++in[place(one.from) + 1];
        }
        partners_.first_sent.assign(1, 0);
        for (const auto& list : out) {
            sent_.insert(sent_.end(), list.begin(), list.end());
            partners_.first_sent.push_back(3 * core::count(sent_));
        }
        for (std::size_t k = 1; k < in.size(); ++k) in[k] += in[k - 1];
        for (const Index first : in) partners_.first_received.push_back(3 * first);
        const Index own_slots = slots[core::at(rank)];
        std::vector<std::pair<Index, Index>> sources;  // vector, place among own slots and, behind them, what is received
        for (const Sent& one : sent)                   // rising by part
            if (one.to == rank) sources.emplace_back(one.vector, one.from == rank ? one.slot : own_slots + in[place(one.from)]++);
        std::stable_sort(sources.begin(), sources.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        for (const auto& [vector, source] : sources) {
            if (vectors_.empty() || vectors_.back() != vector)
                vectors_.push_back(vector), first_.push_back(core::count(sources_));
            sources_.push_back(source);
        }
        first_.push_back(core::count(sources_));
        out_.resize(3 * sent_.size()), in_.resize(core::at(partners_.received()));
        own_slots_ = own_slots;
    }

    /// z of own vectors = the sum of what the slots of all parts have.
    template <Exchange E>
    void sum(const E& exchange, const Vector& slots, Vector& z, Traffic& traffic) {
        if (exchange.ranks() > 1) {
            for (std::size_t k = 0; k < sent_.size(); ++k)
                for (std::size_t i = 0; i < 3; ++i) out_[3 * k + i] = slots[3 * sent_[k] + static_cast<Index>(i)];
            exchange.swap(partners_, out_, in_);
            traffic.messages += core::count(partners_.ranks), traffic.bytes += 8 * core::count(out_);
        }
        core::parallel_for(
            core::count(vectors_),
            [&](Index k) {
                Vec3 sum = Vec3::Zero();
                for (Index s = first_[core::at(k)]; s < first_[core::at(k + 1)]; ++s) {
                    const Index source = sources_[core::at(s)];
                    if (source < own_slots_)
                        sum += slots.segment<3>(3 * source);
                    else
                        sum += Vec3(in_[core::at(3 * (source - own_slots_))], in_[core::at(3 * (source - own_slots_) + 1)],
                                    in_[core::at(3 * (source - own_slots_) + 2)]);
                }
                z.segment<3>(3 * vectors_[core::at(k)]) = sum;
            },
            core::light_items);
    }

private:
    Partners partners_;
    std::vector<Index> sent_, vectors_, first_, sources_;
    Index own_slots_ = 0;
    std::vector<double> out_, in_;
};

}  // namespace fibrant::distributed
