"""What each rule of the workflow does: tables and recordings in, tables out.

A module here belongs to one stage and joins the library's parts over the
recordings of a shard or the tables of a corpus. Reading and writing of files is
the scripts' part (workflow/scripts).
"""
