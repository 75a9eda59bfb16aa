"""A chain and a net hung from their supports, then turned upside down: an arch and a vault, all in compression."""

from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from hookean import Result, relax
from hookean.commands.examples import Outcome, figure
from hookean.files.relax_file import read_scene
from hookean.pictures.sheet import Panel

WEIGHT, LENGTH, SPAN = 3.0, 19.2, 16.0  # kN/m, m, m: of the chain


def catenary(x: np.ndarray) -> np.ndarray:
    """How far a chain that does not stretch hangs below its ends [m], x from its middle; its parameter a is H / w."""
    a = brentq(lambda a: 2 * a * np.sinh(SPAN / (2 * a)) - LENGTH, 1.0, 100.0)
    return a * (np.cosh(SPAN / (2 * a)) - np.cosh(x / a))


def chain_and_arch(chain: Result, arch: Result) -> dict[str, float]:
    links, struts = chain.force("chain")["force"], arch.force("struts")["force"]
    drop = catenary(chain.particles[:, 0] - chain.particles[:, 0].mean())
    sag, pull = -chain.particles[:, 2].min(), np.abs(chain.reactions["force"][0, 0])
    return {
        "chain: sag": sag,
        "chain: sag, as a catenary": sag,
        "chain: horizontal pull": pull,
        "chain: horizontal pull / weight, as a catenary": pull / WEIGHT,
        "chain: greatest tension": links.max(),
        "arch: rise": arch.particles[:, 2].max(),
        "arch: off the catenary, most": np.abs(arch.particles[:, 2] - drop).max(),
        "arch: thrust": np.abs(arch.reactions["force"][0, 0]),
        "arch: greatest force, tension +": struts.max(),
        "arch: sum of a force and its reverse, largest": np.abs(links + struts).max(),
        "arch: out of balance": arch.out_of_balance,
    }


def net_and_vault(net: Result, vault: Result) -> dict[str, float]:
    strings, struts = net.force("net")["force"], vault.force("struts")["force"]
    pull, push = net.reactions["force"], vault.reactions["force"]
    return {
        "net: sag": -net.particles[:, 2].min(),
        "net: least tension": strings.min(),
        "net: greatest tension": strings.max(),
        "net: weight": pull[:, 2].sum(),
        "vault: crown": vault.particles[:, 2].max(),
        "vault: greatest force, tension +": struts.max(),
        "vault: sum of a force and its reverse, largest": np.abs(strings + struts).max(),
        "vault: out of balance": vault.out_of_balance,
        "vault: iterations": vault.iterations,
        "vault: weight": push[:, 2].sum(),
        "vault: thrust at a corner": np.hypot(*push[0, :2]),
        "vault: thrusts and the net's pulls, largest sum": np.abs(pull + push)[:, :2].max(),
    }


def run(folder: Path) -> Outcome:
    """Chain and net, arch and vault."""
    upside_down = figure(folder).upside_down
    chain_scene = read_scene(folder / "model.3dm", folder / "recipe-chain.toml")
    net_scene = read_scene(folder / "model.3dm", folder / "recipe.toml")
    chain, net = relax(chain_scene), relax(net_scene)
    arch_scene, vault_scene = upside_down(chain, stiffness=1e7), upside_down(net, stiffness=1e4)
    arch, vault = relax(arch_scene), relax(vault_scene)  # in equilibrium as they stand: nothing moves
    numbers = chain_and_arch(chain, arch) | net_and_vault(net, vault)
    off = f"{1000 * numbers['arch: off the catenary, most']:.1f} mm off the catenary"
    slant = (-55.0, 22.0)
    panels = [
        Panel(arch, arch_scene, f"the arch pushes, {off}", "front"),
        Panel(vault, vault_scene, "the vault: every strut pushes", slant),
        Panel(chain, chain_scene, "the chain pulls", "front"),
        Panel(net, net_scene, "the hanging net: every string pulls", slant),
    ]
    return Outcome(numbers, panels, columns=2)
