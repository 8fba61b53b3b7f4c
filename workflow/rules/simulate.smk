# Corpora with known truth: a rule a simulator, where this run has its corpus. Their files are then
# read like any corpus's.

if "lsf-sim" in PLAN.simulated:
    LSF_SIM = PLAN.simulated["lsf-sim"]

    rule simulate_lsf:
        """Signing with known truth, written as BVH and ELAN files."""
        input:
            description=PLAN.description(LSF_SIM),
            table2=PLAN.papers / "naert2017" / "table2.csv",
            constants=PLAN.papers / "naert2017" / "constants.csv",
        output:
            data=collect(
                "<results>/{corpus}/simulated/{file}",
                corpus=LSF_SIM,
                file=PLAN.corpora[LSF_SIM].files(),
            ),
            truth=f"<results>/{LSF_SIM}/simulated/truth.csv",
            design=f"<results>/{LSF_SIM}/simulated/design.csv",
        log:
            f"<logs>/{LSF_SIM}/simulate.log",
        params:
            code=PLAN.digest("stages/simulate_lsf.py"),
            corpus=lambda w: str(PLAN.corpora[LSF_SIM].folder),
            seed=SETTINGS.seed,
            euclidean_unit_m=SETTINGS.transitions.euclidean_unit_m,
        script:
            "../scripts/stages/simulate_lsf.py"


if "isl-sim" in PLAN.simulated:
    ISL_SIM = PLAN.simulated["isl-sim"]

    rule simulate_isl:
        """Repeated single signs with known strokes, written as CSV files."""
        input:
            description=PLAN.description(ISL_SIM),
        output:
            data=collect(
                "<results>/{corpus}/simulated/{file}",
                corpus=ISL_SIM,
                file=PLAN.corpora[ISL_SIM].files(),
            ),
            strokes=f"<results>/{ISL_SIM}/simulated/strokes.csv",
            true_path=f"<results>/{ISL_SIM}/simulated/true_path.parquet",
        log:
            f"<logs>/{ISL_SIM}/simulate.log",
        priority: LONGEST_CHAIN
        params:
            code=PLAN.digest("stages/simulate_isl.py"),
            corpus=lambda w: str(PLAN.corpora[ISL_SIM].folder),
            seed=SETTINGS.seed,
            recipe=SETTINGS.simulation.isl,
        script:
            "../scripts/stages/simulate_isl.py"
