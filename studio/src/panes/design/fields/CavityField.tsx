// Which chamber a load or a metric means: by its name, all of them, or by its number.

import { Select } from "../../../controls/Choice";
import { cavityOptions } from "../../../controls/cavities";
import { useStudio } from "../../../store/studio";
import { useForm } from "../form";

export function CavityField(props: {
  label: string;
  value: unknown;
  help?: string | undefined;
  onChange(value: string | number): void;
}) {
  const { source } = useForm();
  const cavities = useStudio((state) => state.body?.cavities);
  const names = Object.keys((source.chambers as object | undefined) ?? {});
  const value = String(props.value ?? "all");
  const options = cavityOptions(names, cavities ?? [], value);
  return (
    <Select
      label={props.label}
      title={
        props.help ?? "A chamber by its name, all of them, or by its number; 0 is the largest."
      }
      value={value}
      options={options}
      onChange={(next) => props.onChange(/^\d+$/.test(next) ? Number(next) : next)}
    />
  );
}
