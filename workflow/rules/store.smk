# Results, copied to a storage service.
RESULTS = [
    "<results>/report/index.html",
    rules.naert2017.input,
    rules.syntheses.input,
    rules.endres2013.input,
    rules.naert2017_durations.input,
    rules.audit.input,
    rules.explorers.input,
]

if SETTINGS.results_store:

    rule store:
        """All of results/, at the address that config.yaml names."""
        input:
            RESULTS,
        output:
            # Without a file of this machine, whatever lies at the address would count as made.
            told="<logs>/stored.txt",
            results=PLAN.remote.file(SETTINGS.results_store),
        log:
            "<logs>/store.log",
        params:
            code=PLAN.digest("stages/store.py"),
            address=SETTINGS.results_store,
        script:
            "../scripts/stages/store.py"
