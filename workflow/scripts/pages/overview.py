from signkin.job import job

with job(snakemake):
    from pathlib import Path

    import matplotlib.pyplot as plt

    from signkin import tables
    from signkin.figures.overview import plot_overview, size
    from signkin.figures.style import paper_style, save
    from signkin.pages import overview

    source, out = snakemake.input, snakemake.output
    dot = overview.rule_graph(Path(source.snakefile), snakemake.params.settings, "all")
    notes = overview.rule_notes([Path(path) for path in source.rules])
    rules = overview.layout(overview.parse_rule_graph(dot), notes)
    tables.write_table(rules, out.csv, "overview")
    with paper_style():
        figure, ax = plt.subplots(figsize=size(rules))
        plot_overview(rules, ax=ax)
        save(figure, out.svg, out.pdf)
