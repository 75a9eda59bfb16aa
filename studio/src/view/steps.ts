// Sets of particles as differences of their numbers: rows and areas become runs of the same few numbers.

export const steps = (set: number[]) => set.map((one, i) => one - (i ? set[i - 1]! : 0));

export function summed(differences: number[]): number[] {
  let sum = 0;
  return differences.map((one) => (sum += one));
}
