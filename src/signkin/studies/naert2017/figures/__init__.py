"""The figures of Naert et al. 2017, a file a family: its numbers, its drawing, its caption.

`of_transitions` draws Fig. 4 to 10, `of_synthesis` Fig. 1, 2, 12 and 13; which, and in which
order, papers/naert2017/exhibits.yaml says.
"""
