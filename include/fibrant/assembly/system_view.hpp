// SPDX-License-Identifier: MIT
#pragma once
/// @file Any system of chains as one type, so that what works on systems is compiled once and not for every beam.

#include <fibrant/assembly/linear_system.hpp>

#include <concepts>
#include <type_traits>
#include <utility>

namespace fibrant::assembly {

/// Any visitor of terms as one type.
class VisitorView {
public:
    template <class Visitor>
    explicit VisitorView(Visitor& visitor) noexcept
        : visitor_{&visitor},
          point_{[](void* own, const PointTerm& term) { static_cast<Visitor*>(own)->point(term); }},
          dense_{[](void* own, const DenseTerm& term) { static_cast<Visitor*>(own)->dense(term); }} {}
    void point(const PointTerm& term) const { point_(visitor_, term); }
    void dense(const DenseTerm& term) const { dense_(visitor_, term); }

private:
    void* visitor_;
    void (*point_)(void*, const PointTerm&);
    void (*dense_)(void*, const DenseTerm&);
};

class SystemView;

/// A system that has all that strategies may ask one of chains for: its couplings are numbered, chains may close, and a part of
/// it may be unsymmetric.
template <class T>
concept WholeChainSystem = !std::same_as<T, SystemView> && DivisibleCouplings<T> && LinearSystem<T> &&
                           requires(const T system, const Vector& x, Vector& y, Index chain, Matrix& blocks) {
    { system.unsymmetric() } -> std::same_as<bool>;
    system.apply_skews(x, y);
    system.chain_corner(chain, blocks);
};

/// A system of chains, whatever its beams: a call through a pointer for each question, a few of which are asked an iteration, and
/// for each term that is visited. The system must outlive it.
class SystemView {
public:
    template <WholeChainSystem System>
    explicit SystemView(const System& system) noexcept : system_{&system}, calls_{&calls_of<System>} {}

    const scene::DofLayout& layout() const { return calls_->layout(system_); }
    void apply(const Vector& x, Vector& y) const { calls_->apply(system_, x, y); }
    void node_blocks(Index chain, Matrix& blocks) const { calls_->node_blocks(system_, chain, blocks); }
    void chain_band(Index chain, Matrix& blocks) const { calls_->chain_band(system_, chain, blocks); }
    void chain_corner(Index chain, Matrix& corner) const { calls_->chain_corner(system_, chain, corner); }
    bool unsymmetric() const { return calls_->unsymmetric(system_); }
    void apply_skews(const Vector& x, Vector& y) const { calls_->apply_skews(system_, x, y); }
    Index couplings() const { return calls_->couplings(system_); }
    template <class Visitor>
    void visit(Visitor& visitor) const {
        const VisitorView seen(visitor);
        calls_->visit(system_, seen);
    }
    template <class Visitor>
    void visit_couplings(Visitor& visitor) const {
        visit_couplings(visitor, 0, couplings());
    }
    template <class Visitor>
    void visit_couplings(Visitor& visitor, Index first, Index last) const {
        const VisitorView seen(visitor);
        calls_->visit_couplings(system_, seen, first, last);
    }

private:
    struct Calls {
        const scene::DofLayout& (*layout)(const void*);
        void (*apply)(const void*, const Vector&, Vector&);
        void (*node_blocks)(const void*, Index, Matrix&);
        void (*chain_band)(const void*, Index, Matrix&);
        void (*chain_corner)(const void*, Index, Matrix&);
        bool (*unsymmetric)(const void*);
        void (*apply_skews)(const void*, const Vector&, Vector&);
        Index (*couplings)(const void*);
        void (*visit)(const void*, const VisitorView&);
        void (*visit_couplings)(const void*, const VisitorView&, Index, Index);
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
                                    [](const void* s, Index chain, Matrix& corner) { as<System>(s).chain_corner(chain, corner); },
                                    [](const void* s) { return as<System>(s).unsymmetric(); },
                                    [](const void* s, const Vector& x, Vector& y) { as<System>(s).apply_skews(x, y); },
                                    [](const void* s) { return as<System>(s).couplings(); },
                                    [](const void* s, const VisitorView& visitor) { as<System>(s).visit(visitor); },
                                    [](const void* s, const VisitorView& visitor, Index first, Index last) {
                                        as<System>(s).visit_couplings(visitor, first, last);
                                    }};

    const void* system_;
    const Calls* calls_;
};
static_assert(LinearSystem<SystemView> && DivisibleCouplings<SystemView>);

/// A system as strategies are to see it: by a view where it is one of chains, as it is else.
template <WholeChainSystem System>
SystemView seen(const System& system) noexcept {
    return SystemView(system);
}
template <class System>
const System& seen(const System& system) noexcept {
    return system;
}
/// What `seen` makes of a system of this type.
template <class System>
using Seen = std::remove_cvref_t<decltype(seen(std::declval<const System&>()))>;

}  // namespace fibrant::assembly
