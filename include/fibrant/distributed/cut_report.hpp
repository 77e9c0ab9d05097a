// SPDX-License-Identifier: MIT
#pragma once
/// @file What a cut into subdomains costs, as if each of them were on a rank of its own.

#include <fibrant/distributed/pair_terms.hpp>
#include <fibrant/distributed/subdomains.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace fibrant::distributed {

/// Numbers of a cut; `most_` is of the part that has most of it.
struct CutReport {
    Index parts = 0, terms = 0;
    Index cut_terms = 0;        ///< terms between chains whose vectors have more than one owner
    Index cut_elements = 0;     ///< elements of beams beside an element of another part
    Index most_nodes = 0;       ///< owned
    Index most_terms = 0;       ///< owned: a term is of the part of its first vector
    Index most_halo_nodes = 0;  ///< read, and owned by others
    Index most_halo_terms = 0;  ///< computed, and owned by others
    Index most_neighbours = 0;  ///< parts that own what is read
    double imbalance = 0.0;     ///< greatest work of a part over the mean [1]
};

/// Takes stock of a cut: what the pieces, the products of beams and those of terms ask other parts for.
template <assembly::VisitedSystem System>
CutReport report_cut(const System& system, const Subdomains& cut) {
    const scene::DofLayout& layout = system.layout();
    const std::vector<int>& owner = cut.owner();
    const assembly::VectorPlaces places(layout);
    const auto node_of = [&](Index v) {  // named by its first vector
        return v - places.number(v) % layout.chains[core::at(places.chain(v))].vectors_per_node;
    };
    PairTerms terms;
    terms.take(system, [](const auto&) { return true; });
    CutReport report;
    report.parts = cut.parts(), report.terms = terms.size(), report.cut_elements = cut.cut_elements(layout);
    std::vector<Index> own(core::at(cut.parts()), 0), computed(core::at(cut.parts()), 0);
    std::vector<std::pair<int, Index>> read;  // part, node
    std::vector<int> touched;
    for (Index k = 0; k < terms.size(); ++k) {
        const auto vectors = terms[k].vectors;
        touched.clear();
        for (const std::int32_t v : vectors) touched.push_back(owner[core::at(v)]);
        ++own[core::at(touched.front())];
        std::sort(touched.begin(), touched.end());
        touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
        for (const int part : touched) ++computed[core::at(part)];
        if (touched.size() == 1) continue;
        ++report.cut_terms;
        for (const int part : touched)
            for (const std::int32_t v : vectors)
                if (owner[core::at(v)] != part) read.emplace_back(part, node_of(v));
    }
    for (const scene::Chain& chain : layout.chains)
        for (Index a = 0; a < chain.nodes; ++a)
            for (Index b = std::max<Index>(0, a - chain.reach); b <= std::min(chain.nodes - 1, a + chain.reach); ++b) {
                const Index v = chain.first_vector + b * chain.vectors_per_node;
                const int part = owner[core::at(chain.first_vector + a * chain.vectors_per_node)];
                if (owner[core::at(v)] != part) read.emplace_back(part, v);
            }
    std::sort(read.begin(), read.end());
    read.erase(std::unique(read.begin(), read.end()), read.end());
    auto from = read.begin();
    for (int part = 0; part < static_cast<int>(cut.parts()); ++part) {
        std::vector<int> others;
        const auto begin = from;
        for (; from != read.end() && from->first == part; ++from) others.push_back(owner[core::at(from->second)]);
        std::sort(others.begin(), others.end());
        others.erase(std::unique(others.begin(), others.end()), others.end());
        Index nodes = 0;
        for (const Index v : cut.owned()[core::at(part)]) nodes += node_of(v) == v;
        report.most_nodes = std::max(report.most_nodes, nodes);
        report.most_terms = std::max(report.most_terms, own[core::at(part)]);
        report.most_halo_nodes = std::max<Index>(report.most_halo_nodes, from - begin);
        report.most_halo_terms = std::max(report.most_halo_terms, computed[core::at(part)] - own[core::at(part)]);
        report.most_neighbours = std::max(report.most_neighbours, core::count(others));
    }
    Index whole = 0, most = 0;
    for (const Index work : cut.work()) whole += work, most = std::max(most, work);
    report.imbalance = static_cast<double>(most * cut.parts()) / static_cast<double>(whole);
    return report;
}

}  // namespace fibrant::distributed
