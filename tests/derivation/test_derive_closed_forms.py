"""Every closed form of A1–A10 equals the derived one: the difference reduces to zero."""

import pytest
import symbolic_forms as sf
import sympy as sp

import pinscrew as ps

CASES = [(robot, tip, what) for (robot, tip), forms in sf.FORMS.items() for what in forms]


@pytest.mark.parametrize(("robot", "tip", "what"), CASES, ids=str)
def test_the_coursework_s_form(robot: str, tip: str | None, what: str) -> None:
    d = sf.derivation(robot, tip)
    mine, right = sf.derived(d, what), sf.expected(robot, tip, what)
    assert mine.shape == right.shape
    for entry, form in zip(mine, right, strict=True):
        assert d.equal(entry, form), f"{entry} is not {form}"


@pytest.mark.parametrize(("robot", "tip", "what"), CASES, ids=str)
def test_a_wrong_form_is_caught(robot: str, tip: str | None, what: str) -> None:
    """The check can fail: the sign of any entry, or a length in it, makes the difference."""
    d = sf.derivation(robot, tip)
    right = sf.expected(robot, tip, what)
    for entry in right:
        if entry:
            assert not d.equal(entry, -entry)
            assert not d.equal(entry, entry + sp.Rational(1, 10**6))


def test_agrees_with_sympy_s_own_simplify() -> None:
    """The normal form's zero is sympy's too."""
    d = sf.derivation("spherical_rrp")
    difference = d.explicit(d.pose) - sf.expected("spherical_rrp", None, "pose")
    assert sp.simplify(difference) == sp.zeros(4)


def test_the_coursework_s_form_is_what_is_written() -> None:
    """Not only equal but so written: common factors and sums of angles kept."""
    d = sf.derivation("spherical_rrp")
    L0, L3 = d.lengths
    theta3 = d.coordinates[2].symbol
    c1, s1, c2, s2 = sp.symbols("c1 s1 c2 s2", real=True)
    r = L3 + theta3
    assert list(d.pose[:3, 3]) == [sp.Mul(-1, r, s1, c2), r * c1 * c2, L0 + sp.Mul(-1, r, s2)]
    d = sf.derivation("planar_rrr")
    l1, l2, l3 = d.lengths
    c1, c12, c123 = sp.symbols("c1 c12 c123", real=True)
    assert d.pose[0, 3] == l1 * c1 + l2 * c12 + l3 * c123


@pytest.mark.parametrize("robot", ["spherical_rrp", "scara_rrp", "anthropomorphic_rrr", "two_joint", "lead_screw"])
def test_both_routes_to_the_body_velocity_are_one_expression(robot: str) -> None:
    assert sf.derivation(robot).velocities_agree


@pytest.mark.parametrize("robot", ["spherical_rrp", "stanford_rrp", "two_joint"])
def test_spatial_jacobian_is_the_adjoint_of_the_body_jacobian(robot: str) -> None:
    """J^s = Ad_g J^b, A9 and A10."""
    d = sf.derivation(robot)
    difference = d.jacobian("spatial") - d.adjoint * d.jacobian("body")
    assert all(d.equal(entry, 0) for entry in difference)


def test_rotation_identities() -> None:
    """A7: columns orthonormal, R⁻¹ = Rᵀ, det R = 1, R S(a) Rᵀ = S(Ra), in symbols."""
    for robot in ("spherical_rrp", "stanford_rrp", "anthropomorphic_rrr"):
        d = sf.derivation(robot)
        R = sp.Matrix(d.pose[:3, :3])
        assert all(d.equal(x, 0) for x in R.T * R - sp.eye(3))
        assert d.equal(sp.expand(R.det(method="berkowitz")), 1)
        for i in range(3):
            a = sp.eye(3)[:, i]
            assert all(d.equal(x, 0) for x in R * a.hat() * R.T - (R * a).hat())


def test_gears_and_lead_screw() -> None:
    """A11: θ2 = -N1/N2 θ1, and one twist of pitch lead/2π."""
    d = sf.derivation("gear_pair")
    N1, N2 = d.lengths
    theta1 = d.coordinates[0].symbol
    assert list(d.follows.values()) == [-N1 / N2 * theta1]
    a = (N1 + N2) / 1000
    assert sp.simplify(d.jacobian("spatial") - sp.Matrix([0, a * N1 / N2, 0, 0, 0, -N1 / N2])) == sp.zeros(6, 1)
    assert d.in_coordinates(d.pose)[0, 0] == sp.cos(N1 * theta1 / N2)
    d = sf.derivation("bevel_pair")
    N1, N2 = d.lengths
    assert d.jacobian("body") == sp.ImmutableMatrix([0, 0, 0, -N1 / N2, 0, 0])
    d = sf.derivation("lead_screw")
    (lead,) = d.lengths
    for kind in ("spatial", "body"):
        assert d.jacobian(kind) == sp.ImmutableMatrix([0, 0, lead / (2 * sp.pi), 0, 0, 1])


def test_symbols_by_name() -> None:
    d = sf.derivation("spherical_rrp")
    assert d.equal(
        d.pose[2, 3], d.symbols["L0"] - sp.sin(d.symbols["theta2"]) * (d.symbols["L3"] + d.symbols["theta3"])
    )
    assert d.symbols["s2"] in d.pose.free_symbols


def test_names_of_joints() -> None:
    robot = ps.load("scara_rrp")
    d = ps.derive(robot, names="d")
    assert [str(v.symbol) for v in d.coordinates] == ["theta1", "theta2", "d3"]
    d = ps.derive(robot, names="urdf")
    assert [str(v.symbol) for v in d.coordinates] == ["joint1", "joint2", "joint3"]
    assert d.prove(5).ok


def test_symbols_are_the_same_whatever_was_asked_for() -> None:
    fresh, used = (ps.derive(ps.load("planar_rrr")) for _ in range(2))
    assert used.adjoint.shape == (6, 6)
    assert fresh.symbols.keys() >= {"l1", "theta1", "dtheta3", "c1", "s2", "c12", "s123", "s23"}
    assert fresh.symbols.keys() <= used.symbols.keys()


def test_equal_takes_a_person_s_own_symbols_and_matrices() -> None:
    """Of assignments' A1: p = [-r s1c2, r c1c2, L0 - r s2]."""
    d = ps.derive(ps.load("spherical_rrp"))
    t1, t2, t3, L0, L3 = sp.symbols("theta1 theta2 theta3 L0 L3")
    p = [-(L3 + t3) * sp.sin(t1) * sp.cos(t2), (L3 + t3) * sp.cos(t1) * sp.cos(t2), L0 - (L3 + t3) * sp.sin(t2)]
    assert d.equal(d.pose[:3, 3], sp.Matrix(p))
    assert not d.equal(d.pose[:3, 3], sp.Matrix([p[0], p[1], -p[2]]))
    assert not d.equal(d.pose[:3, 3], sp.Matrix([p]))
    assert d.equal(d.pose[2, 3], p[2])
