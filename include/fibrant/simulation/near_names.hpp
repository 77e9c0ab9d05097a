// SPDX-License-Identifier: MIT
#pragma once
/// @file Names that are taken for a slip of the pen: parts that a model may leave out are found by their names, and one that is
/// misspelt would be left out in silence.

namespace fibrant::simulation::detail {

template <class M>
concept NearTools = requires {
    typename M::Tool;
}
|| requires { typename M::tools; }
|| requires { typename M::Tols; }
|| requires { typename M::Tolls; }
|| requires { typename M::Toosl; }
|| requires { typename M::Toools; }
|| requires { typename M::RigidTools; };
template <class M>
concept NearConnections = requires {
    typename M::Connection;
}
|| requires { typename M::connections; }
|| requires { typename M::Conections; }
|| requires { typename M::Connectons; }
|| requires { typename M::Connetions; }
|| requires { typename M::Connectoins; }
|| requires { typename M::Connexions; }
|| requires { typename M::Ties; }
|| requires { typename M::Bodies; }
|| requires { typename M::RigidBodies; };
template <class M>
concept NearSolid = requires {
    typename M::Solids;
}
|| requires { typename M::solid; }
|| requires { typename M::Soild; }
|| requires { typename M::Sold; }
|| requires { typename M::Solidd; }
|| requires { typename M::BondedSolid; };
template <class M>
concept NearPassage = requires {
    typename M::Passages;
}
|| requires { typename M::passage; }
|| requires { typename M::Pasage; }
|| requires { typename M::Passge; }
|| requires { typename M::Passaeg; }
|| requires { typename M::NoPassage; };
template <class M>
concept NearActs = requires {
    typename M::Act;
}
|| requires { typename M::acts; }
|| requires { typename M::Atcs; }
|| requires { typename M::Term; }
|| requires { typename M::Terms; }
|| requires { typename M::Loads; }
|| requires { typename M::Forces; }
|| requires { typename M::Actions; };
template <class M>
concept NearSteps = requires {
    typename M::Step;
}
|| requires { typename M::steps; }
|| requires { typename M::Setps; }
|| requires { typename M::StepControl; }
|| requires { typename M::Stepping; }
|| requires { typename M::HalvedSteps; };

}  // namespace fibrant::simulation::detail
