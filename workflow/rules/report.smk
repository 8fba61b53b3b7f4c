# The overview of the workflow and the pages that show everything.
from signkin.provenance import commit


rule overview:
    """This graph (Fig. 3)."""
    input:
        snakefile=Path(workflow.basedir) / "Snakefile",
        rules=sorted((Path(workflow.basedir) / "workflow" / "rules").glob("*.smk")),
    output:
        svg="<results>/naert2017/fig03.svg",
        pdf="<results>/naert2017/fig03.pdf",
        csv="<results>/naert2017/fig03.csv",
    log:
        "<logs>/overview.log",
    params:
        code=PLAN.digest("pages/overview.py"),
        settings=SETTINGS,
        corpora=sorted(PLAN.corpora),
    script:
        "../scripts/pages/overview.py"


rule report:
    """The pages you are reading."""
    input:
        rules.naert2017.input,
        rules.endres2013.input,
        rules.naert2017_durations.input,
        rules.audit.input,
        rules.explorers.input,
        overview=rules.overview.output,
        shared=collect(rules.gather.output, corpus=PLAN.corpora),
        synthesis=rules.syntheses.input,
        speeds=collect(rules.wrist_speeds.output, corpus=PLAN.untagged),
        endres=PLAN.papers / "endres2013" / "exhibits.yaml",
        paper=[
            PLAN.papers / "naert2017" / name
            for name in ("exhibits.yaml", "constants.csv", "table2.csv")
        ],
        descriptions=[PLAN.description(corpus) for corpus in PLAN.corpora],
        fetched=PLAN.fetched_files(),  # whose hashes the pages tell
    output:
        front="<results>/report/index.html",
        pages=[f"<results>/report/{name}.html" for name in ("methods", "provenance")],
        data_files="<results>/report/data_files.csv",
        summary="<results>/report/summary.txt",
        corpora=directory("<results>/report/corpora"),
        papers=directory("<results>/report/papers"),
        images=directory("<results>/report/images"),
    log:
        "<logs>/report.log",
    params:
        code=PLAN.digest("pages/report.py"),
        commit=commit(),
        folders={name: str(folder) for name, folder in PLAN.folders.items()},
        corpora={name: str(corpus.folder) for name, corpus in PLAN.corpora.items()},
        missing=dict(PLAN.missing),
        settings=SETTINGS.model_copy(update={"data_dir": None, "results_store": None}),
    script:
        "../scripts/pages/report.py"
