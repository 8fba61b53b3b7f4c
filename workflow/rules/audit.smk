# The audit: every claim of the papers on print and on the corpora of this run.


rule claims:
    """The ledger: a verdict for every claim and piece of evidence."""
    input:
        rules.naert2017.input,
        rules.naert2017_durations.input,
        rules.endres2013.input,
        collect(rules.claim_choices.output, corpus=PLAN.tagged),
        shared=collect(rules.gather.output, corpus=PLAN.corpora),
        papers=PLAN.claim_files(),
    output:
        claims="<results>/audit/claims.csv",
        checks="<results>/audit/checks.csv",
    log:
        "<logs>/audit/claims.log",
    params:
        code=PLAN.digest("pages/claims.py"),
        papers=[str(folder) for folder in PLAN.claimed],
        corpora={
            name: corpus.simulator is not None for name, corpus in PLAN.corpora.items()
        },
    script:
        "../scripts/pages/claims.py"


rule curves:
    """What the claims rest on: a specification curve for each."""
    input:
        collect(rules.claim_choices.output, corpus=PLAN.tagged),
        rules.endres2013.input,
        papers=PLAN.claim_files(),
    output:
        folder=directory("<results>/audit/curves"),
    log:
        "<logs>/audit/curves.log",
    params:
        code=PLAN.digest("pages/curves.py"),
        papers=[str(folder) for folder in PLAN.claimed],
        corpora={
            name: corpus.simulator is not None for name, corpus in PLAN.corpora.items()
        },
    script:
        "../scripts/pages/curves.py"


rule audit_page:
    """The audit as a page."""
    input:
        claims=rules.claims.output.claims,
        checks=rules.claims.output.checks,
        curves=rules.curves.output.folder,
        wrists=collect(rules.one_wrist.output.one_wrist, corpus=PLAN.continuous),
        papers=PLAN.claim_files(),
    output:
        page="<results>/audit/index.html",
        printed=directory("<results>/audit/printed"),
    log:
        "<logs>/audit/page.log",
    params:
        code=PLAN.digest("pages/audit.py"),
        papers=[str(folder) for folder in PLAN.claimed],
    script:
        "../scripts/pages/audit.py"


rule audit:
    """The audit of both papers: claims.csv, the curves and the page."""
    input:
        rules.claims.output,
        rules.curves.output,
        rules.audit_page.output,
