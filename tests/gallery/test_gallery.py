"""Every example of the gallery runs from a plain checkout, is short, and its numbers are right."""

import ast
import io
import math
import runpy
import tokenize
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib.figure import Figure

import stylobate as st

GALLERY = Path(__file__).parents[2] / "gallery"
EXAMPLES = sorted(path.stem.removeprefix("plot_") for path in GALLERY.glob("plot_*.py"))


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Names that an example leaves behind, and what it printed; each example runs once."""
    namespaces = {}

    def example(name):
        if name not in namespaces:
            with pytest.MonkeyPatch.context() as patch:
                patch.chdir(tmp_path_factory.mktemp(name))
                patch.setattr("sys.argv", [f"plot_{name}.py"])
                printed = io.StringIO()
                patch.setattr("sys.stdout", printed)
                with matplotlib.rc_context():
                    matplotlib.use("agg")
                    names = runpy.run_path(str(GALLERY / f"plot_{name}.py"))
                namespaces[name] = names | {"printed": printed.getvalue(), "files": list(Path().iterdir())}
        return namespaces[name]

    return example


def code_lines(path):
    """Lines that hold code: without the docstring, comments and empty lines."""
    text = path.read_text(encoding="utf-8")
    head = ast.parse(text).body[0]
    idle = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER}
    lines = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in idle:
            lines |= set(range(token.start[0], token.end[0] + 1))
    return len(lines - set(range(head.lineno, head.end_lineno + 1)))


@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_runs_and_is_short(run, name):
    example = run(name)
    assert code_lines(GALLERY / f"plot_{name}.py") < 30
    assert isinstance(example["figure"], Figure)
    assert any(file.suffix == ".png" for file in example["files"])
    assert example["printed"]


def uplift(drums):
    """d/(2 (z_C − z)) of every joint of a column of circular drums [g], its centroids by 20 000 slices a drum."""
    accelerations = []
    for first in range(len(drums)):
        area = moment = base = 0.0
        for height, low, high in drums[first:]:
            z = (np.arange(20_000) + 0.5) / 20_000
            slices = (low + (high - low) * z) ** 2 * height
            area += slices.mean()
            moment += (slices * (base + z * height)).mean()
            base += height
        width = min(drums[first][1], drums[first - 1][2]) if first else drums[first][1]
        accelerations.append(0.5 * width * area / moment)
    return accelerations


def test_survey(run):
    # Each joint opens at g d/(2 (z_C − z)), centroids by quadrature over slices; a column that is safe stands at the end.
    example = run("survey")
    expected = uplift(example["survey"])
    assert example["column"].joint_uplift_accelerations / st.g == pytest.approx(expected, rel=1e-6)
    assert f"rocks from {min(expected):.3f} g on" in example["printed"]
    assert not example["response"].collapsed
    assert example["response"].measures.decided
    # The pulse moves the top by less than a tenth of the base width, and by more than the elastic joints would.
    assert 0.01 < example["response"].peak_top_displacement < 0.1 * example["column"].base_width


def test_own_record(run):
    # Six decimals of g in the table, eight digits in AT2: the motions agree to half a unit of the last one.
    example = run("own_record")
    table, at2 = (st.read_motion(example["folder"] / name) for name in ("own.csv", "own.at2"))
    assert table.acceleration == pytest.approx(example["motion"].acceleration, abs=0.51e-6 * st.g)
    assert at2.acceleration == pytest.approx(example["motion"].acceleration, rel=1e-6, abs=1e-9)
    assert table.dt == at2.dt == pytest.approx(example["motion"].dt, rel=1e-12)
    assert table.pga == pytest.approx(0.3 * st.g, abs=1e-6 * st.g)
    # "Some centimetres": half to fifteen, whatever the rounding does; the base is 96 cm wide.
    assert all(not response.collapsed and response.measures.decided for response in example["responses"])
    assert all(0.005 < response.peak_top_displacement < 0.15 for response in example["responses"])


def test_critical_amplitude(run):
    # The boundaries are the same with a quarter of the time step; two steps of the grid (0.02 g) are allowed.
    result = run("critical_amplitude")["result"]
    rows = result.alternation
    assert list(rows["verdict"]) == ["stands", "collapsed", "stands", "collapsed"]
    assert list(rows["from_g"]) == pytest.approx([0.10, 0.46, 0.88, 1.30], abs=0.04)
    assert result.critical > result.column.uplift_acceleration
    # Who falls where, as the text says it.
    for amplitude, side in ((0.6, 1.0), (1.5, -1.0)):
        pulse = run("critical_amplitude")["pulse"].scaled(amplitude * st.g)
        response = st.simulate(result.column, pulse, st.DistinctElement2D())
        assert response.collapsed
        assert np.sign(response.top_displacement[-1]) == side


def test_domain(run):
    # 41.7 % of the cells; with half and a quarter of the time step 40.8 and 41.8 %. Below the static uplift none may fall.
    example = run("domain")
    domain = example["domain"]
    assert domain.counts["failed"] == 0
    assert domain.counts["undecided"] < 0.02 * domain.verdicts.size
    assert domain.counts["collapsed"] / domain.verdicts.size == pytest.approx(0.417, abs=0.02)
    low = domain.amplitudes < domain.column.uplift_acceleration
    assert (domain.verdicts[:, low] == "stands").all()
    # "The boundary begins at the acceleration that opens a joint": in the next cell above it.
    assert np.nanmin(domain.first_collapse) == pytest.approx(domain.amplitudes[~low][0])


def test_compare_models(run):
    # First and second swing of the block models within 5 % of Housner's block (theory page of the rigid block model).
    example = run("compare_models")
    beam, housner, *others = st.compare_models(
        example["column"], st.harmonic(1.0, 0.3 * st.g, 1.5), example["models"]
    ).responses
    for response in others:
        assert response.peak_top_displacement == pytest.approx(housner.peak_top_displacement, rel=0.05)
    assert beam.peak_top_displacement > 1.1 * housner.peak_top_displacement
    # Share of the cells that collapse: the beam's is the largest, the others' within 12 points of each other.
    shares = {domain.model: np.mean(domain.verdicts == "collapsed") for domain in example["comparison"].domains}
    assert shares["rigid-beam"] == max(shares.values()) == pytest.approx(0.56, abs=0.04)
    blocks = [shares[name] for name in ("housner", "rigid-block", "dem2d")]
    assert max(blocks) - min(blocks) < 0.12
    assert np.mean(blocks) == pytest.approx(0.48, abs=0.04)


def test_scatter(run):
    # Half of the columns: 112 of 200, and as many with half of the time step. The 99.9 % interval of that is 44 to 67 %.
    example = run("scatter")
    assert 0.44 < example["fallen"] / 200 < 0.67
    assert example["table"]["decided"].mean() > 0.95
    # Every column that stands has rocked to more than half of its base width.
    assert example["peaks"].min() > 0.5


def test_probability(run):
    result = run("probability")["result"]
    # Below the uplift of the most slender column, 1.25 % narrower and higher and 0.75 % aside, none may fall.
    low = result.amplitudes < 0.96 * result.column.uplift_acceleration
    assert low.any()
    assert (result.frequency[:, low] == 0.0).all()
    # A quarter of the cells is uncertain: 62 of 256, with half of the time step too; a fifth to a third is allowed.
    share = np.mean(result.kinds == "some collapse")
    assert 0.2 < share < 0.33
    assert np.nanmedian(result.band_width) / st.g == pytest.approx(0.38, abs=0.1)


def test_as_found(run):
    # The base joint opens where the weight passes through the end of its contact: with e the way from there to the
    # line of the centroid and h its height, a/g = tan(arctan(e/h) − tilt), by hand for the damaged side.
    example = run("as_found")
    column = example["built"]
    mass, h = column.masses, column.centroid_height
    shift = 0.04 * mass[4:].sum() / mass.sum()
    e = 0.5 * column.base_width - 0.12 - shift
    by_hand = math.tan(math.atan2(e, h) - math.radians(0.5))
    assert example["damaged"].uplift_acceleration / st.g == pytest.approx(by_hand, rel=1e-6)
    printed = example["printed"]
    assert f"as found: a joint opens at {by_hand:.3f} g" in printed
    assert "refused: 'as built' is not in equilibrium: at joint 1" in printed
    # Built, found, turned: the same with half of the time step; two steps of the grid (0.02 g) are allowed.
    values = [float(line.split()[-2]) for line in printed.splitlines() if "pulse ×" in line]
    assert values == pytest.approx([0.56, 0.32, 0.44], abs=0.04)


def test_pushover_check(run):
    # Overturning about the base corner: B/(2 z_C) = 0.20463; zero force at the angle α, the top turned about that corner.
    example = run("pushover_check")
    column, path, limit = example["column"], example["path"], example["limit"]
    exact = 0.5 * column.base_width / column.centroid_height
    assert exact == pytest.approx(0.20463, abs=1e-5)
    assert limit.multiplier == pytest.approx(exact, rel=1e-9)
    assert path.collapse_multiplier == pytest.approx(exact, rel=1e-3)
    angle, half = math.atan(exact), 0.5 * column.base_width
    turned = half - half * math.cos(angle) + column.height * math.sin(angle)
    assert path.ultimate_displacement == pytest.approx(turned, rel=2e-3)
    # Circolare 617/2009: usable is 0.4 of the displacement d₀* at zero force; passed at 1.5 times the demand.
    check = example["check"]
    assert check.usable_displacement == pytest.approx(0.4 * check.zero_displacement, rel=1e-12)
    assert check.factor == pytest.approx(1.49, abs=0.02)
    assert example["printed"].endswith("passed\n")


def test_record_suite(run):
    # Same PGA within a fifth; the peaks of those that stand rise with PGV; from 0.8 m/s on both columns fall.
    table = run("record_suite")["table"]
    assert table["pga_g"].max() < 1.25 * table["pga_g"].min()
    for _, rows in table.groupby("column"):
        ordered = rows.sort_values("pgv_m_s")
        stands = ordered[ordered["verdict"] == "stands"]
        assert stands["peak_top_over_base_width"].is_monotonic_increasing
        assert (ordered["pgv_m_s"] > 0.8).equals(ordered["verdict"] == "collapsed")


def test_rocking_spectrum(run):
    # Uplift at PGA = g tan α: α = arctan 0.4 = 21.80°, found to the step of the grid, 0.54°.
    example = run("rocking_spectrum")
    step = np.diff(example["spectrum"].slenderness)[0]
    assert 0.0 <= example["closed"] - math.atan(0.4) <= step
    # The largest block stands, the smallest falls up to a larger angle than the middle one: size is stability.
    collapsed = example["spectrum"].collapsed
    assert not collapsed[0].any()
    assert collapsed[39].sum() > collapsed[20].sum() > 0


def test_collapse(run):
    # The ledger of a fall closes within 1 % of the released energy; drums stand or have fallen; all lies still.
    response = run("collapse")["response"]
    mechanism = response.mechanism
    assert response.collapsed
    assert response.energy_imbalance < 0.01
    assert mechanism.at_rest
    assert len(mechanism.fallen) >= 6
    assert run("collapse")["printed"].startswith(mechanism.describe())


def test_portal(run):
    # Makris and Vassiliou (2013): the frame opens at g tan α = 0.2 g of its columns. Below, the stiff joints' flexibility
    # moves it by under a millimetre; above, it moves as far as its uplift lets it.
    example = run("portal")
    moved = [float(line.split()[-2]) for line in example["printed"].splitlines()[:2]]
    assert moved[0] < 1.0 < 10.0 < moved[1]
    assert set(example["response"].fallen) == {"left", "right", "architrave"}
    assert example["response"].at_rest
    assert example["response"].energy_imbalance < 0.01


def test_in_space(run):
    # b/h over the larger cosine of square columns; of round ones 0.2 g all round, less 1 − cos 3.75° at most.
    limits = run("in_space")["limits"]
    assert limits.multipliers == pytest.approx(np.full(len(limits.multipliers), 0.2), rel=2.2e-3)
    assert "square: 0.2000 g at 0°, at most 0.2828 g; moving: south-west, north-west" in run("in_space")["printed"]


def test_temple_corner(run):
    """Masses by hand: of a frustum of a cone, of the parts of a capital; a pulse over twice the limit brings all down."""
    example = run("temple_corner")
    cone = math.pi / 12.0 * 5.2 * (0.8**2 + 0.8 * 0.677 + 0.677**2) * 2500.0
    neck = math.pi / 4.0 * 0.1333 * 0.677**2 + math.pi / 12.0 * 0.1333 * (0.677**2 + 0.677 * 0.867 + 0.867**2)
    shaft, capital, *_ = example["corner"].stones
    assert shaft.mass == pytest.approx(cone, rel=1e-9)
    assert capital.mass == pytest.approx(2500.0 * (neck + 0.1334 * 0.867**2), rel=1e-9)
    response = example["response"]
    assert response.collapsed
    assert len(response.fallen) >= 7
    assert response.measures.energy_imbalance < 0.01


def test_fragility(run):
    # PGV tells more than PGA: dispersions 0.066 and 0.19 from brackets of 4 to 8 %; a factor 1.5 is asked for.
    example = run("fragility")
    best = example["best"].set_index("measure")
    assert best.loc["pgv", "beta"] < best.loc["pga", "beta"] / 1.5
    assert best.loc["pga", "p_pgv_over_pga_s"] < 0.05
    # Capacities lie between 0.74 and 0.97 m/s; their median by the bracket of the sixth and seventh of twelve.
    assert example["curve"].median == pytest.approx(0.83, abs=0.06)
    severe, mild = example["stood"].probability
    assert 0.1 < severe < 0.4 < 0.8 < mild < 0.92
    assert severe == pytest.approx(mild**10.0, rel=1e-6)  # ten times the rate


def test_study(run):
    example = run("study")
    assert "240 cases, 240 of them computed now" in example["printed"]
    assert "480 cases, 240 of them computed now" in example["printed"]
    shares = example["result"].table.groupby("im")["collapsed"].mean()
    # Population: 80 runs a level; neither the weakest motions collapse most of the columns, nor the strongest few.
    assert shares.iloc[0] < 0.25
    assert shares.iloc[-1] > shares.iloc[0] + 0.25
    assert example["curve"].median_interval[0] < example["curve"].median < example["curve"].median_interval[1]


def test_notebook_survey(run):
    # The survey's column stands a pulse of about twice its uplift acceleration, and so does every column like it.
    example = run("notebook_survey")
    response, population = example["response"], example["sure"].population
    assert not response.collapsed
    assert population.counts["collapsed"] == 0
    assert "Collapses in 0 of 15" in example["printed"]
    # the film and the response show themselves, with nothing of a network and no script outside the film's frame
    assert "<script" not in response._repr_html_()
    film = response.animate(window=(0.0, 0.5))
    assert film._repr_html_().startswith('<iframe sandbox="allow-scripts" srcdoc="&lt;!doctype html&gt;')
    assert "<script" not in film._repr_html_()
    assert "<script" in film.page


def test_notebook_fragility(run):
    example = run("notebook_fragility")
    assert len(example["motions"]) == 10
    assert set(example["analysis"].runs["record"]) == {f"record-{seed}.csv" for seed in range(10)}
    # the curve's median lies among the capacities that it is fitted to
    capacities = example["analysis"].capacities
    low, high = capacities["stands_until"].min(), capacities["collapses_from"].max()
    assert low < example["curve"].median < high
    assert len(example["figure"].axes) >= 2


def test_worth_it(run):
    # The core closes what rocking opens: it saves a third of the runs and harms none. The dowels are within chance.
    dowels, core = run("worth_it")["comparison"].differences
    assert core.share_high < -0.15
    assert core.harmed <= 1 < 10 < core.saved
    assert abs(dowels.share) < 0.15
    assert run("worth_it")["comparison"].links.set_index("state").loc["core", "broken"] == 0


def test_what_shaking(run):
    """Every accepted draw leaves the states as they are seen; that the stout one stands tells least of all."""
    inference = run("what_shaking")["inference"]
    assert set(inference.draws["stout: state"]) == {"stands"}
    assert set(inference.draws["slender: state"]) == {"fell"}
    alone = {row["observation"]: row["spread_alone"] for row in inference.information}
    assert inference.posterior["pgv_m_s"].spread < alone["stout stands"] == max(alone.values())
    assert "peak ground velocity was" in run("what_shaking")["printed"]


def test_many_sites(run):
    """Weights by the closed form of lognormal fragilities under a rate k v⁻², k θ⁻² exp(2 β²), over 20,000 draws.

    Windows of temple and arch do not overlap, and sites have earthquakes of their own: probabilities multiply.
    """
    weighing, rng = run("many_sites")["weighing"], np.random.default_rng(0)
    z, between = rng.standard_normal((2, 3, 20_000)), rng.random((2, 20_000))

    def drawn(best, low, high, z):
        sides = np.where(z < 0.0, math.log(best / low), math.log(high / best)) / 1.96
        return best * np.exp(sides * z)

    bears = [(0.70, 0.45, 1.0), (0.60, 0.4, 0.9), (0.30, 0.2, 0.45)]
    column, temple, arch = (
        drawn(*capacity, z[0, i]) ** -2 * np.exp(2.0 * drawn(0.5, 0.35, 0.7, z[1, i]) ** 2)
        for i, capacity in enumerate(bears)
    )
    weights = []
    for before, often in ((0.3, 0.004), (0.5, 0.012), (0.2, 0.036)):
        k = often * 0.1**2
        stands = np.exp(-k * column * (2380 + 70 * between[0])) * np.exp(-k * arch * 800)
        weights.append(before * np.mean(stands * -np.expm1(-k * temple * (2480 - 1400 - 100 * between[1]))))
    # 64 by 16 draws of what is not known: a standard error of a hundredth, four of them are let through.
    assert weighing.weight == pytest.approx(np.array(weights) / sum(weights), abs=0.04)


def test_ruins_of_rome():
    """The ruins of the documentation's real case: 100 Roman feet high, twins, one of them with a drum out of place."""
    read_ruin = pytest.importorskip("stylobate_ruins.ruin_files").read_ruin
    both, alone = (read_ruin(GALLERY / "ruins" / f"{name}.toml") for name in ("rome", "aurelius_alone"))
    aurelius, trajan = both.structures
    assert aurelius.height == pytest.approx(100 * 0.2957, rel=0.002)  # a Roman foot of 295.7 mm
    assert aurelius.nameless_digest == trajan.nameless_digest == alone.structures[0].nameless_digest
    assert [fact.kind for fact in both.facts] == ["state", "largest", "state", "no slip above"]
    assert both.facts[:2] == alone.facts
