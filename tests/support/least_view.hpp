// SPDX-License-Identifier: MIT
#pragma once
/// @file Any linear system as the least one, so that strategies are compiled once and not for every kind of system that tests
/// have.

#include <fibrant/assembly/system_view.hpp>

namespace fibrant::test {

/// What strategies may ask of any linear system, and nothing faster. The system must outlive it.
class LeastView {
public:
    template <assembly::LinearSystem System>
    explicit LeastView(const System& system) noexcept : system_{&system}, calls_{&calls_of<System>} {}
    const scene::DofLayout& layout() const { return calls_->layout(system_); }
    void apply(const Vector& x, Vector& y) const { calls_->apply(system_, x, y); }
    void node_blocks(Index chain, Matrix& blocks) const { calls_->node_blocks(system_, chain, blocks); }
    void chain_band(Index chain, Matrix& blocks) const { calls_->chain_band(system_, chain, blocks); }
    template <class Visitor>
    void visit(Visitor& visitor) const {
        const assembly::VisitorView seen(visitor);
        calls_->visit(system_, seen);
    }

private:
    struct Calls {
        const scene::DofLayout& (*layout)(const void*);
        void (*apply)(const void*, const Vector&, Vector&);
        void (*node_blocks)(const void*, Index, Matrix&);
        void (*chain_band)(const void*, Index, Matrix&);
        void (*visit)(const void*, const assembly::VisitorView&);
    };
    template <class System>
    static const System& as(const void* system) noexcept {
        return *static_cast<const System*>(system);
    }
    template <class System>
    static constexpr Calls calls_of{[](const void* s) -> const scene::DofLayout& { return as<System>(s).layout(); },
                                    [](const void* s, const Vector& x, Vector& y) { as<System>(s).apply(x, y); },
                                    [](const void* s, Index chain, Matrix& blocks) { as<System>(s).node_blocks(chain, blocks); },
                                    [](const void* s, Index chain, Matrix& blocks) { as<System>(s).chain_band(chain, blocks); },
                                    [](const void* s, const assembly::VisitorView& visitor) { as<System>(s).visit(visitor); }};

    const void* system_;
    const Calls* calls_;
};
static_assert(assembly::LinearSystem<LeastView> && !assembly::DivisibleCouplings<LeastView>);

template <assembly::LinearSystem System>
LeastView least(const System& system) noexcept {
    return LeastView(system);
}

}  // namespace fibrant::test
