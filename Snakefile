# The entry of the workflow: configuration, the rules of each stage, and the targets.


configfile: "config.yaml"


pathvars:
    results="results",
    logs="logs",


include: "workflow/rules/common.smk"
include: "workflow/rules/simulate.smk"
include: "workflow/rules/ingest.smk"
include: "workflow/rules/kinematics.smk"
include: "workflow/rules/kernels.smk"
include: "workflow/rules/naert2017.smk"
include: "workflow/rules/one_wrist.smk"
include: "workflow/rules/endres2013.smk"
include: "workflow/rules/explorer.smk"
include: "workflow/rules/audit.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/store.smk"


rule all:
    """Everything this run can make."""
    default_target: True
    input:
        RESULTS,
        rules.store.output if SETTINGS.results_store else [],


# Snakemake compares params of Python's own types alone, so what settings say is told as text, too:
# else a changed key would make nothing anew.
for each in workflow.rules:
    if settings_told := told_as_text(each.params):
        each.set_params(settings_told=settings_told)
