"""What a user may write in a mechanism file of format 1: one module per section of the file.

The models are the contract of the file: keys, kinds of values, fixed lengths, names. Numbers stay
text here; units, expressions and references between sections are the business of whoever builds the
mechanism. `validate` turns plain data into a `MechanismFile`, `json_schema` describes the same for
editors.
"""
