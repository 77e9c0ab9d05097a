// SPDX-License-Identifier: MIT
#pragma once
/// @file Which friction and which penetration pairs of groups have, where a scene says so.

#include <fibrant/contact/zone_stiffness.hpp>
#include <fibrant/scene/assembly.hpp>

#include <vector>

namespace fibrant::contact {

/// Rules of a scene by pairs of fibres: read once, and empty where there are none.
class PairRules {
public:
    PairRules() = default;
    explicit PairRules(const scene::Assembly& assembly) : rules_(assembly.rules()) {
        if (rules_.empty()) return;
        groups_ = core::count(assembly.groups());
        table_.assign(core::at(groups_ * groups_), -1);
        for (Index k = 0; k < core::count(rules_); ++k) {
            const Index a = rules_[core::at(k)].first, b = rules_[core::at(k)].second;
            table_[core::at(a * groups_ + b)] = table_[core::at(b * groups_ + a)] = k;
        }
        for (const scene::FibreSpecification& fibre : assembly.fibres()) {
            ancestors_.emplace_back();  // the innermost first
            for (Index group = fibre.group; group >= 0; group = assembly.groups()[core::at(group)].parent)
                ancestors_.back().push_back(group);
        }
        for (const scene::FibreImage& image : assembly.images())
            ancestors_.push_back(std::vector<Index>(ancestors_[core::at(image.fibre)]));
    }

    /// Sets what the rules say of a zone: that of the innermost groups of its two fibres for which there is one.
    void apply(Zone& zone) const {
        if (rules_.empty()) return;
        const std::vector<Index>&own = ancestors_[core::at(zone.span.fibre_i)], &other = ancestors_[core::at(zone.span.fibre_j)];
        for (std::size_t depth = 0; depth < own.size() + other.size(); ++depth)
            for (std::size_t a = 0; a <= depth; ++a) {
                if (a >= own.size() || depth - a >= other.size()) continue;
                const Index rule = table_[core::at(own[a] * groups_ + other[depth - a])];
                if (rule < 0) continue;
                zone.friction_factor = rules_[core::at(rule)].friction_factor;
                zone.penetration_factor = rules_[core::at(rule)].penetration_factor;
                return;
            }
    }

private:
    std::vector<scene::PairRule> rules_;
    std::vector<Index> table_;
    std::vector<std::vector<Index>> ancestors_;  // of each fibre
    Index groups_ = 0;
};

}  // namespace fibrant::contact
